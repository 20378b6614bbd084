"""Tag expressions: which frames a search may choose, said as `(walk | run) & !crouch`.

    expression = term { "|" term }
    term       = factor { "&" factor }
    factor     = "!" factor | "(" expression ")" | tag
    tag        = letters, digits, "-", "_", "."

`!` binds strongest, then `&`, then `|`. Parsed once, evaluated on the library's tag bits.
"""

import difflib
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from stridewire._errors import InvalidRequestError, Violation
from stridewire.motion.array_types import Flags, Indices


@dataclass(frozen=True)
class Expression:
    """A parsed expression: an operator over parts, or a tag."""

    operator: str
    """`!` with one part, `&` or `|` with several, or empty for a tag."""
    parts: tuple["Expression", ...] = ()
    tag: str = ""


MAX_LENGTH = 1000
MAX_DEPTH = 32
_TOKEN = re.compile(r"\s*([A-Za-z0-9_.-]+|[()&|!])")


def parse(text: str, path: str, tags: Sequence[str]) -> Expression:
    """Parse an expression over known tags.

    Args:
        text: The expression; at most 1,000 characters.
        path: Field path for errors.
        tags: Tags of the library.

    Raises:
        InvalidRequestError: Pointing at the character that is wrong, or naming near tags.
    """
    return _Parser(text, path, tags).parse()


def evaluate(expression: Expression, tag_bits: Indices, tags: Sequence[str]) -> Flags:
    """Return `(F,)`: rows for which the expression holds.

    Args:
        expression: From `parse`.
        tag_bits: `(F,)` uint64, bit i for `tags[i]`.
        tags: Tags of the library, in the order of the bits.
    """
    if not expression.operator:
        bit = np.uint64(tags.index(expression.tag))
        return np.asarray((tag_bits >> bit) & np.uint64(1) == 1)
    flags = [evaluate(part, tag_bits, tags) for part in expression.parts]
    if expression.operator == "!":
        return ~flags[0]
    combine = np.logical_and if expression.operator == "&" else np.logical_or
    return np.asarray(combine.reduce(flags))


class _Parser:
    """Recursive descent over the tokens of one expression."""

    def __init__(self, text: str, path: str, tags: Sequence[str]) -> None:
        self._text = text
        self._path = path
        self._tags = tags
        self._at = 0
        self._depth = 0

    def parse(self) -> Expression:
        if len(self._text) > MAX_LENGTH:
            what = f"has {len(self._text)} characters; allowed are {MAX_LENGTH}"
            raise InvalidRequestError.of(Violation(self._path, what))
        expression = self._any()
        if self._peek():
            raise self._wrong(f"{self._peek()!r} cannot follow here; join by & or |")
        return expression

    def _any(self) -> Expression:
        return self._joined("|", self._all)

    def _all(self) -> Expression:
        return self._joined("&", self._one)

    def _joined(self, operator: str, part: Callable[[], Expression]) -> Expression:
        parts = [part()]
        while self._peek() == operator:
            self._take()
            parts.append(part())
        return parts[0] if len(parts) == 1 else Expression(operator, tuple(parts))

    def _one(self) -> Expression:
        token = self._peek()
        if token and token in "!(":
            return self._nested(token)
        if not token or token in ")&|":
            raise self._wrong("a tag, ! or ( is expected here")
        if token not in self._tags:
            raise self._unknown(token)
        self._take()
        return Expression("", tag=token)

    def _nested(self, opening: str) -> Expression:
        self._depth += 1
        if self._depth > MAX_DEPTH:
            raise self._wrong(f"is nested deeper than {MAX_DEPTH}")
        self._take()
        if opening == "!":
            inner = Expression("!", (self._one(),))
        else:
            inner = self._any()
            if self._peek() != ")":
                raise self._wrong("a ) is missing here")
            self._take()
        self._depth -= 1
        return inner

    def _peek(self) -> str:
        match = _TOKEN.match(self._text, self._at)
        if match:
            return match.group(1)
        if self._text[self._at :].strip():
            raise self._wrong("this character has no meaning; allowed are tags, ! & | ( )")
        return ""

    def _take(self) -> None:
        match = _TOKEN.match(self._text, self._at)
        assert match is not None
        self._at = match.end()

    def _unknown(self, tag: str) -> InvalidRequestError:
        near = difflib.get_close_matches(tag, self._tags, 3, 0.5)
        known = f"did you mean {', '.join(near)}?" if near else f"tags: {', '.join(self._tags)}"
        return self._wrong(f"no clip has the tag {tag!r}; {known}")

    def _wrong(self, what: str) -> InvalidRequestError:
        rest = self._text[self._at :]
        column = self._at + len(rest) - len(rest.lstrip())
        pointer = f"{self._text}\n{' ' * column}^"
        return InvalidRequestError.of(
            Violation(self._path, f"at character {column + 1}: {what}\n{pointer}")
        )
