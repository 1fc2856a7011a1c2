"""An XML document as a tree that remembers where in the user's file each element stands.

Expat reads the XML, and entities that the document declares for itself are expanded within bounds. External entities,
document types and style sheets are never fetched: they are counted.
"""

from __future__ import annotations

import codecs
import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import NoReturn
from xml.parsers import expat

from planner.drawing.entities import Entities
from planner.errors import DrawingError

ELEMENT_LIMIT = 250_000
DEPTH_LIMIT = 500
SVG_NAMESPACE = "http://www.w3.org/2000/svg"
_PREFIXES = {
    "http://www.w3.org/1999/xlink": "xlink",
    "http://www.w3.org/XML/1998/namespace": "xml",
    "http://www.inkscape.org/namespaces/inkscape": "inkscape",
    "http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd": "sodipodi",
    "http://www.serif.com/": "serif",
}
"""The prefix by which attributes of a namespace are known here, whatever the file calls it."""
_BUILT_IN = {"xml": "http://www.w3.org/XML/1998/namespace", "xmlns": "http://www.w3.org/2000/xmlns/"}
_DECLARED_ENCODING = re.compile(rb"<\?xml[^>]{0,200}?\sencoding\s*=\s*[\"']([A-Za-z0-9._-]{1,40})[\"']")
_NATIVE_ENCODINGS = frozenset({"utf-8", "iso8859-1", "ascii"})


@dataclass(eq=False, slots=True)
class Element:
    """tag: the local name of an element of SVG, "" for one of another namespace. attributes: by plain name; those of
    other namespaces by the prefix that everyone knows, whatever the file calls it: `xlink:href`, `xml:space`,
    `inkscape:label`, `inkscape:groupmode`, `sodipodi:insensitive`. content: children and character data in
    order. line: in the file, from 1."""

    tag: str
    attributes: dict[str, str]
    line: int
    parent: Element | None = None
    content: list[Element | str] = field(default_factory=list)

    @property
    def children(self) -> list[Element]:
        return [item for item in self.content if isinstance(item, Element)]

    @property
    def text(self) -> str:
        """Its own character data, without that of its children."""
        return "".join(item for item in self.content if isinstance(item, str))

    def descendants(self) -> Iterable[Element]:
        """Itself and all elements in it, in the order of the document."""
        pending = [self]
        while pending:
            element = pending.pop()
            yield element
            pending.extend(reversed(element.children))


@dataclass(frozen=True, eq=False, slots=True)
class Document:
    """by_id: the first element of each id. source: what messages call the file. skipped: what the document refers to
    outside itself, by kind."""

    source: str
    root: Element
    by_id: dict[str, Element]
    skipped: Counter[str]


def read_tree(data: bytes, source: str) -> Document:
    """The document, its entities expanded within bounds. Errors: DrawingError with the line of the user's file."""
    data, encoding = _readable(data)
    builder = _Builder(data, encoding, source)
    try:
        builder.parser.Parse(data, True)
    except expat.ExpatError as error:
        message = expat.ErrorString(error.code) or "unknown fault"
        raise DrawingError(source, f"not well-formed XML: {message} in line {error.lineno}") from None
    except (LookupError, ValueError) as error:
        raise DrawingError(source, f"not readable XML: {' '.join(str(error).split())}") from None
    if builder.root is None:  # expat reports a document without any element as an error
        raise DrawingError(source, "not an SVG: it has no elements")
    return Document(source, builder.root, builder.by_id, builder.skipped)


def _readable(data: bytes) -> tuple[bytes, str | None]:
    """Data that expat can read, and the encoding that it must be told, if any.

    Some programs declare UTF-16 and write UTF-8, which browsers read as what it is; encodings with several bytes a
    character are unknown to expat.
    """
    match = _DECLARED_ENCODING.match(data)
    if not match:
        return data, None
    try:
        name = codecs.lookup(match[1].decode()).name
        if name.startswith(("utf-16", "utf-32")):
            return data, "utf-8"
        if name in _NATIVE_ENCODINGS or len(bytes(range(256)).decode(name, "replace")) == 256:
            return data, None
        return data.decode(name).encode(), "utf-8"
    except (LookupError, UnicodeError):
        return data, None  # expat says what is wrong with it


class _Scope:
    """Namespaces by prefix, as they are in force for an element, and what names mean under them."""

    __slots__ = ("_keys", "_svg", "_tags", "namespaces")

    def __init__(self, namespaces: dict[str, str], svg: frozenset[str]) -> None:
        """svg: the namespaces whose elements are of SVG: none at all is one where the root has none."""
        self.namespaces = namespaces
        self._svg = svg
        self._tags: dict[str, str] = {}
        self._keys: dict[str, str] = {}

    def within(self, attributes: dict[str, str]) -> _Scope:
        """That of an element with these attributes."""
        declared = {
            key[6:]: value.strip() for key, value in attributes.items() if key.startswith("xmlns:") or key == "xmlns"
        }
        return _Scope({**self.namespaces, **declared}, self._svg) if declared else self

    def tag(self, name: str) -> str:
        """The local name, or "" where it is not of SVG. Errors: KeyError, the prefix."""
        tag = self._tags.get(name)
        if tag is None:
            prefix, _, local = name.rpartition(":")
            namespace = self.namespaces[prefix] if prefix else self.namespaces.get("", "")
            tag = self._tags[name] = local if namespace in self._svg else ""
        return tag

    def attributes(self, given: dict[str, str]) -> dict[str, str]:
        """Renamed, without those of unknown namespaces. Errors: KeyError, the prefix."""
        keys = self._keys
        result = {}
        for name, value in given.items():
            key = keys.get(name)
            if key is None:
                key = keys[name] = self._key(name)
            if key:
                result[key] = value
        return result

    def _key(self, name: str) -> str:
        prefix, colon, local = name.rpartition(":")
        if not colon:
            return "" if name == "xmlns" else name
        known = _PREFIXES.get(self.namespaces[prefix])
        return f"{known}:{local}" if known else ""


class _Builder:
    def __init__(self, data: bytes, encoding: str | None, source: str) -> None:
        self.root: Element | None = None
        self.by_id: dict[str, Element] = {}
        self.skipped: Counter[str] = Counter()
        self._data = data
        self._source = source
        self._n_elements = 0
        self._open: list[Element] = []
        self._scopes = [_Scope(_BUILT_IN, frozenset({SVG_NAMESPACE}))]
        self._texts: list[str] = []
        self._doctype = ""
        self._entities = Entities(self._refuse)
        self.parser = parser = expat.ParserCreate(encoding)
        parser.buffer_text = True
        parser.StartDoctypeDeclHandler = self._start_doctype
        parser.EndDoctypeDeclHandler = self._end_doctype
        parser.EntityDeclHandler = self._entity
        parser.ExternalEntityRefHandler = self._external_entity
        parser.SkippedEntityHandler = self._skipped_entity
        parser.ProcessingInstructionHandler = self._instruction
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.CharacterDataHandler = self._texts.append

    def _refuse(self, reason: str) -> NoReturn:
        raise DrawingError(self._source, reason)

    def _start_doctype(self, name: str, *_: object) -> None:
        self._doctype = name

    def _entity(self, name: str, is_parameter: bool, value: str | None, *_: object) -> None:
        if not is_parameter and value is not None:
            self._entities.declare(name, value)

    def _end_doctype(self) -> None:
        if self._entities:
            is_wide = self._data[:2] in (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE) or 0 in self._data[:2]
            text = self._data.decode("utf-16" if is_wide else "utf-8", "replace")
            self._entities.check(text)

    def _external_entity(self, *_: object) -> int:
        self.skipped["external reference"] += 1
        return 1

    def _skipped_entity(self, _: str, is_parameter: bool) -> None:
        if is_parameter:
            self.skipped["external reference"] += 1
        elif any(element.tag == "text" for element in self._open):  # browsers leave it out, and it shows nowhere else
            self.skipped["entity that is declared elsewhere"] += 1

    def _instruction(self, target: str, _: str) -> None:
        if target == "xml-stylesheet":
            self.skipped["external reference"] += 1

    def _start(self, name: str, given: dict[str, str]) -> None:
        line = self.parser.CurrentLineNumber
        if self.root is None:
            self._enter_root(name, given, line)
        scope = self._scopes[-1].within(given)
        try:
            element = Element(scope.tag(name), scope.attributes(given), line)
        except KeyError as unknown:
            self._refuse_prefix(unknown.args[0], line)
        self._n_elements += 1
        if self._n_elements > ELEMENT_LIMIT:
            self._refuse(f"more than {ELEMENT_LIMIT} elements (split it into several drawings)")
        if len(self._open) >= DEPTH_LIMIT:
            self._refuse(f"elements nested more than {DEPTH_LIMIT} deep in line {line}")
        if self._open:
            parent = self._open[-1]
            element.parent = parent
            if self._texts:
                self._flush(parent)
            parent.content.append(element)
        else:
            self.root = element
            self._texts.clear()
        self._open.append(element)
        self._scopes.append(scope)
        if "id" in element.attributes:
            self.by_id.setdefault(element.attributes["id"], element)

    def _enter_root(self, name: str, given: dict[str, str], line: int) -> None:
        prefix, _, local = name.rpartition(":")
        key = f"xmlns:{prefix}" if prefix else "xmlns"
        namespace = given.get(key, "").strip()
        if local == "svg" and not prefix and not namespace:
            self._scopes = [_Scope(_BUILT_IN, frozenset({SVG_NAMESPACE, ""}))]
        elif local == "svg" and prefix and key not in given:
            self._refuse_prefix(prefix, line)
        elif local == "svg" and namespace != SVG_NAMESPACE:
            self._refuse(f'not an SVG: its namespace is "{namespace[:80]}" (make that {key}="{SVG_NAMESPACE}")')
        elif local != "svg":
            is_page = "html" in (local.lower(), self._doctype.lower())
            advice = " (a web page: save the <svg> in it as a file of its own)" if is_page else ""
            self._refuse(f"not an SVG: the outermost element is <{name[:40]}> in line {line}{advice}")

    def _refuse_prefix(self, prefix: str, line: int) -> NoReturn:
        known = next((uri for uri, name in _PREFIXES.items() if name == prefix), None)
        known = SVG_NAMESPACE if prefix == "svg" else known
        advice = f'add xmlns:{prefix}="{known}" to its <svg>' if known else "remove it, or save it as plain SVG"
        self._refuse(f'not well-formed XML: undeclared prefix "{prefix[:40]}:" in line {line} ({advice})')

    def _end(self, _: str) -> None:
        element = self._open.pop()
        self._scopes.pop()
        if self._texts:
            self._flush(element)

    def _flush(self, element: Element) -> None:
        element.content.append("".join(self._texts))
        self._texts.clear()
