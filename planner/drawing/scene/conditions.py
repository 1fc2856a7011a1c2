"""Elements that are shown under conditions."""

from __future__ import annotations

from planner.drawing.xml_tree import Element

_EXTENSIONS = frozenset({"http://www.w3.org/1999/xhtml", "http://www.w3.org/1998/Math/MathML"})


def is_met(element: Element) -> bool:
    """Whether the conditions of an element hold for a reader of English."""
    languages = element.attributes.get("systemLanguage")
    if languages is not None and not any(_is_english(word.strip().lower()) for word in languages.split(",")):
        return False
    extensions = element.attributes.get("requiredExtensions")
    return extensions is None or (bool(extensions.split()) and set(extensions.split()) <= _EXTENSIONS)


def fitting_child(switch: Element) -> Element | None:
    """The child of a `switch` that is shown: the first one of SVG whose conditions hold. A `foreignObject`, which no
    pen draws, is passed over where there is another one: it says the same in other words."""
    fitting = [child for child in switch.children if child.tag and is_met(child)]
    return next((child for child in fitting if child.tag != "foreignObject"), fitting[0] if fitting else None)


def _is_english(language: str) -> bool:
    return language == "en" or language.startswith("en-")
