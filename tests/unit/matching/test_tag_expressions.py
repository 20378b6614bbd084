"""Tag expressions: parsed once, evaluated on bits, errors that point at the character."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stridewire._errors import InvalidRequestError
from stridewire_engine.matching.tag_expressions import MAX_DEPTH, MAX_LENGTH, evaluate, parse

TAGS = ("crouch", "run", "turn-left", "walk")
BITS = np.arange(16, dtype=np.uint64)
HOLDS = {tag: (np.arange(16) >> i & 1).astype(bool) for i, tag in enumerate(TAGS)}


def value(text: str) -> np.ndarray:
    """Evaluate an expression on all combinations of tags."""
    return evaluate(parse(text, "filter", TAGS), BITS, TAGS)


def test_the_operators_bind_as_stated() -> None:
    """`!` before `&` before `|`; parentheses first."""
    walk, run, crouch = (HOLDS[tag] for tag in ("walk", "run", "crouch"))
    assert np.array_equal(value("walk | run & !crouch"), walk | (run & ~crouch))
    assert np.array_equal(value("(walk|run)&!crouch"), (walk | run) & ~crouch)
    assert np.array_equal(value("!(walk & run)"), ~(walk & run))
    assert np.array_equal(value(" turn-left "), HOLDS["turn-left"])


names = st.sampled_from(TAGS).map(lambda tag: (tag, HOLDS[tag]))


def joined(children: st.SearchStrategy) -> st.SearchStrategy:
    """Join expressions beside their values."""
    return st.one_of(
        children.map(lambda a: (f"!({a[0]})", ~a[1])),
        st.tuples(children, children)
        .map(lambda ab: (f"({ab[0][0]}) & {ab[1][0]}", None, ab))
        .map(lambda x: (f"(({x[2][0][0]}) & ({x[2][1][0]}))", x[2][0][1] & x[2][1][1])),
        st.tuples(children, children).map(
            lambda ab: (f"(({ab[0][0]}) | ({ab[1][0]}))", ab[0][1] | ab[1][1])
        ),
    )


@given(st.recursive(names, joined, max_leaves=8))
def test_any_expression_means_what_it_says(case: tuple[str, np.ndarray]) -> None:
    """Random expressions have the values of numpy's own operators."""
    text, expected = case
    assert np.array_equal(value(text), expected)


@given(st.text(alphabet="walkrun()!&|$ -", max_size=30))
def test_any_text_is_parsed_or_refused(text: str) -> None:
    """Whatever is typed, the answer is an expression or an error of the field."""
    fields = ["filter"]
    try:
        parse(text, "filter", TAGS)
    except InvalidRequestError as error:
        fields = [violation.field for violation in error.violations]
    assert fields == ["filter"]


@pytest.mark.parametrize(
    ("text", "column", "said"),
    [
        ("walk &", 7, "a tag"),
        ("walk run", 6, "cannot follow"),
        ("(walk", 6, "missing"),
        ("walk)", 5, "cannot follow"),
        ("walk & & run", 8, "a tag"),
        ("walk $ run", 6, "no meaning"),
        ("", 1, "a tag"),
        ("wlak", 1, "did you mean walk"),
        ("run | zzzz", 7, "tags: crouch"),
    ],
)
def test_errors_point_at_the_character(text: str, column: int, said: str) -> None:
    """The message has the column, a caret under it, and what to do."""
    with pytest.raises(InvalidRequestError, match=f"at character {column}: ") as caught:
        parse(text, "filter", TAGS)
    message = str(caught.value)
    assert said in message
    assert message.splitlines()[-1] == " " * (column - 1) + "^"


def test_length_and_depth_have_limits() -> None:
    """On the limit an expression is parsed, above it refused, and nothing overflows the stack."""
    assert value("(" * MAX_DEPTH + "walk" + ")" * MAX_DEPTH).any()
    padded = "walk" + " " * (MAX_LENGTH - 4)
    assert value(padded).any()
    for text in ("(" * (MAX_DEPTH + 1) + "walk", padded + " ", "!" * 999 + "walk"):
        with pytest.raises(InvalidRequestError):
            parse(text, "filter", TAGS)
