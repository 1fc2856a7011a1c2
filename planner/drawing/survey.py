"""A first pass over the XML for the normaliser: what is in it, and whether it is safe to hand on."""

from __future__ import annotations

from array import array
from dataclasses import dataclass
from xml.parsers import expat

from planner.errors import DrawingError

DEPTH_LIMIT = 500
ELEMENT_LIMIT = 250_000
SVG_NAMESPACE = "http://www.w3.org/2000/svg"
SHAPES = frozenset({"path", "rect", "circle", "ellipse", "line", "polyline", "polygon"})


@dataclass(frozen=True, slots=True)
class Survey:
    """What a first pass over the XML found.

    css: the text of all style sheets. has_markers: whether markers are defined.
    n_shapes: shape elements anywhere, rendered or not; shape_ids: their ids.
    root: attributes of the outermost `svg`.
    """

    css: str
    has_markers: bool
    n_shapes: int
    shape_ids: frozenset[str]
    root: dict[str, str]


def survey(data: bytes, source: str) -> Survey:
    """Check the document and say what is in it.

    Raises DrawingError for anything but a well-formed SVG of bounded depth and size whose `use`
    elements neither recur nor multiply beyond ELEMENT_LIMIT.
    """
    surveyor = _Surveyor(source)
    parse(data, surveyor.parser, source)
    surveyor.check_expansion()
    return Survey(
        "".join(surveyor.css), surveyor.has_markers, surveyor.n_shapes, frozenset(surveyor.shape_ids), surveyor.root
    )


def parse(data: bytes, parser: expat.XMLParserType, source: str) -> None:
    """Feed `data` to `parser`; malformed XML becomes a DrawingError with its line."""
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        message = expat.ErrorString(error.code) or "unknown fault"
        raise DrawingError(source, f"not well-formed XML: {message} in line {error.lineno}") from None
    except (LookupError, ValueError) as error:
        raise DrawingError(source, f"not readable XML: {' '.join(str(error).split())}") from None


def local_name(name: str) -> str:
    """`circle` for `svg:circle`."""
    return name.rpartition(":")[2]


def href_of(attributes: dict[str, str]) -> str:
    """The reference of an element; plain `href` goes before any prefixed one."""
    if "href" in attributes:
        return attributes["href"].strip()
    return next((value.strip() for name, value in attributes.items() if local_name(name) == "href"), "")


class _Surveyor:
    def __init__(self, source: str) -> None:
        self.source = source
        self.css: list[str] = []
        self.has_markers = False
        self.n_shapes = 0
        self.shape_ids: set[str] = set()
        self.root: dict[str, str] = {}
        self._stack: list[int] = []
        self._in_style = 0
        self._parents = array("q")
        self._ids: dict[str, int] = {}
        self._references: dict[int, str] = {}
        self.parser = expat.ParserCreate()
        self.parser.buffer_text = True
        self.parser.StartDoctypeDeclHandler = self._doctype
        self.parser.EntityDeclHandler = self._entity
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._text

    def _doctype(self, name: str, system: str | None, public: str | None, has_internal_subset: bool) -> None:
        if has_internal_subset:
            raise DrawingError(
                self.source, "declares a document type of its own, which is not accepted (save it as plain SVG)"
            )
        if system and not (public or "").startswith("-//W3C//DTD SVG"):
            raise DrawingError(
                self.source, "refers to a foreign document type, which is not accepted (save it as plain SVG)"
            )

    def _entity(self, *_: object) -> None:
        raise DrawingError(self.source, "declares entities, which are not accepted (save it as plain SVG)")

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        tag = local_name(name)
        index = len(self._parents)
        if index == 0:
            prefix = name.rpartition(":")[0]
            namespace = attributes.get(f"xmlns:{prefix}" if prefix else "xmlns", SVG_NAMESPACE)
            if tag != "svg" or namespace != SVG_NAMESPACE:
                raise DrawingError(self.source, f"not an SVG: the outermost element is <{name[:40]}>")
            self.root = attributes
        if index >= ELEMENT_LIMIT:
            raise DrawingError(self.source, f"more than {ELEMENT_LIMIT} elements")
        if len(self._stack) >= DEPTH_LIMIT:
            raise DrawingError(self.source, f"elements nested more than {DEPTH_LIMIT} deep")
        self._parents.append(self._stack[-1] if self._stack else -1)
        self._stack.append(index)
        if "id" in attributes:
            self._ids.setdefault(attributes["id"], index)
        if tag in SHAPES:
            self.n_shapes += 1
            if "id" in attributes:
                self.shape_ids.add(attributes["id"])
        elif tag == "use":
            self._references[index] = href_of(attributes)
        elif tag == "marker":
            self.has_markers = True
        elif tag == "style":
            self._in_style += 1

    def _end(self, name: str) -> None:
        self._stack.pop()
        if local_name(name) == "style":
            self._in_style -= 1

    def _text(self, text: str) -> None:
        if self._in_style:
            self.css.append(text)

    def check_expansion(self) -> None:
        """Count the elements after every `use` is replaced by its target: memoised, so linear in the document."""
        if not self._references:
            return
        successors: dict[int, list[int]] = {}
        for index, parent in enumerate(self._parents):
            if parent >= 0:
                successors.setdefault(parent, []).append(index)
        for index, href in self._references.items():
            target = self._ids.get(href[1:]) if href.startswith("#") else None
            if target is not None:
                successors.setdefault(index, []).append(target)
        sizes: dict[int, int] = {}
        heights: dict[int, int] = {}
        entered = {0}
        pending = [(0, iter(successors.get(0, ())))]
        while pending:
            index, rest = pending[-1]
            following = next((other for other in rest if other not in sizes), None)
            if following is not None:
                if following in entered:
                    raise DrawingError(self.source, "a `use` element refers to itself, directly or in a circle")
                entered.add(following)
                pending.append((following, iter(successors.get(following, ()))))
                continue
            pending.pop()
            below = successors.get(index, ())
            sizes[index] = 1 + sum(sizes[other] for other in below)
            heights[index] = 1 + max((heights[other] for other in below), default=0)
        if sizes[0] > ELEMENT_LIMIT:
            raise DrawingError(self.source, f"its `use` elements multiply to more than {ELEMENT_LIMIT} elements")
        if heights[0] > DEPTH_LIMIT:
            raise DrawingError(self.source, f"its `use` elements nest more than {DEPTH_LIMIT} deep")
