"""Candidate sets: the rows that a search may choose under a filter, indexed on demand."""

from collections import OrderedDict
from collections.abc import Callable
from functools import cached_property, partial
from typing import NamedTuple

import faiss
import numpy as np

from stridewire._errors import InvalidRequestError, Violation
from stridewire.motion.array_types import Flags, Floats, Indices
from stridewire_engine import compiled
from stridewire_engine.library import Library
from stridewire_engine.matching import tag_expressions
from stridewire_engine.matching.boxes import RUN, Boxes
from stridewire_engine.matching.index import ExactIndex
from stridewire_engine.matching.inverted_lists import Grouping, InvertedLists, narrow
from stridewire_engine.matching.schema import Schema

EXACT_ROWS = 20_000
"""Sets up to this size are scanned row by row; larger ones look into inverted lists."""
_OWN_LISTS_SHARE = 0.8
"""Larger sets below this share of all rows get lists of their own."""
_CACHED_SETS = 64


class Index(NamedTuple):
    """What gives the nearest of some rows, and which rows a larger index is held to."""

    rows: ExactIndex | InvertedLists
    selector: "faiss.IDSelector | None" = None


class CandidateSet:
    """Rows that satisfy one filter."""

    def __init__(
        self,
        text: str,
        satisfied: Flags,
        rows: Indices,
        boxes: Boxes | None,
        make_index: Callable[[], Index],
    ) -> None:
        """Take what was found for a filter.

        Args:
            text: The filter's expression; empty for all rows.
            satisfied: `(F,)`: rows for which the filter holds, startable or not.
            rows: Rows that may be chosen, ascending.
            boxes: The same, for searches of one row; None where nothing is compiled.
            make_index: Called when more rows than one are first asked for.
        """
        self.text = text
        self.satisfied = satisfied
        self.rows = rows
        self.boxes = boxes
        self._make_index = make_index

    def __len__(self) -> int:
        """Return the number of rows that may be chosen."""
        return len(self.rows)

    @cached_property
    def index(self) -> Index:
        """What gives more rows than one."""
        return self._make_index()

    @property
    def is_exact(self) -> bool:
        """Whether every row is looked at."""
        return isinstance(self.index.rows, ExactIndex)

    def look_into(self, probes: int) -> None:
        """Set into how many lists a search looks, where there are lists."""
        if isinstance(self.index.rows, InvertedLists):
            self.index.rows.probes = probes

    def nearest(self, augmented: Floats, k: int, *, exhaustive: bool = False) -> Indices:
        """Return `(N, min(k, rows))` rows nearest to augmented queries; -1 where none were found.

        Args:
            augmented: From `augment_queries`.
            k: Number of rows.
            exhaustive: Look into every list.
        """
        index = self.index.rows
        if isinstance(index, ExactIndex):
            return index.search(augmented, k)
        return index.search(augmented, min(k, len(self)), self.index.selector, exhaustive)


class Candidates:
    """All candidate sets of one library."""

    def __init__(self, library: Library, schema: Schema, bias: Floats) -> None:
        """Index the rows that may be chosen.

        Args:
            library: With its grouping into lists, where it has one.
            schema: Of its features.
            bias: `(F,)` cost that each row carries.
        """
        self._library = library
        self._schema = schema
        self._bias = bias
        self._cache: OrderedDict[str, CandidateSet] = OrderedDict()
        rows = np.flatnonzero(library.startable)
        self.lists: InvertedLists | None = None
        """The index of large sets; None where every set is scanned."""
        lists = library.grouping
        if lists is not None and len(rows) > EXACT_ROWS:
            grouping = Grouping(lists.centroids, lists.lists)
            self.lists = InvertedLists(schema, library.features, bias, rows, grouping, lists.probes)
        everything = np.ones(len(library.features), np.bool_)
        index = Index(self.lists or ExactIndex(schema, library.features, bias, rows))
        self.everything = CandidateSet("", everything, rows, self._boxes(rows), lambda: index)

    def get(self, text: str, path: str) -> CandidateSet:
        """Return the set of a filter; the most recent ones are kept.

        Args:
            text: A tag expression; empty means all rows.
            path: Field path for errors.

        Raises:
            InvalidRequestError: If the expression is malformed or no row satisfies it.
        """
        text = text.strip()
        if not text:
            return self.everything
        if text not in self._cache:
            library = self._library
            expression = tag_expressions.parse(text, path, library.tag_names)
            satisfied = tag_expressions.evaluate(expression, library.tag_bits, library.tag_names)
            rows = np.flatnonzero(satisfied & library.startable)
            if not len(rows):
                raise InvalidRequestError.of(Violation(path, _nothing(library, text, satisfied)))
            self._cache[text] = self.of_rows(text, satisfied, rows)
            if len(self._cache) > _CACHED_SETS:
                self._cache.popitem(last=False)
        self._cache.move_to_end(text)
        return self._cache[text]

    def look_into(self, probes: int) -> None:
        """Set into how many lists every search looks."""
        for among in (self.everything, *self._cache.values()):
            among.look_into(probes)

    def of_rows(self, text: str, satisfied: Flags, rows: Indices) -> CandidateSet:
        """Index some rows.

        Args:
            text: What the set is called.
            satisfied: `(F,)` rows that belong to it, startable or not.
            rows: Those that may be chosen, ascending.
        """
        return CandidateSet(text, satisfied, rows, self._boxes(rows), partial(self._index, rows))

    def _index(self, rows: Indices) -> Index:
        library = self._library
        if self.lists is None or len(rows) <= EXACT_ROWS:
            return Index(ExactIndex(self._schema, library.features, self._bias, rows))
        if len(rows) < _OWN_LISTS_SHARE * len(self.everything):
            return Index(self._own_lists(rows))
        allowed = np.zeros(len(library.features), np.bool_)
        allowed[rows] = True
        # FAISS keeps a pointer to the bitmap; its Python wrapper keeps the array alive
        return Index(self.lists, faiss.IDSelectorBitmap(np.packbits(allowed, bitorder="little")))

    def _boxes(self, rows: Indices) -> Boxes | None:
        """Put rows into boxes where they are scanned by compiled code."""
        if not compiled.ENABLED:
            return None
        library, stored = self._library, self._library.grouping
        groups: Indices = np.arange(len(rows)) // RUN
        if stored is not None:
            groups = stored.lists[np.searchsorted(np.flatnonzero(library.startable), rows)]
        return Boxes(self._schema, library.features, self._bias, library.clip_of, rows, groups)

    def _own_lists(self, rows: Indices) -> InvertedLists:
        """Index some rows apart: in the common lists, a query would mostly look at others."""
        stored = self._library.grouping
        assert stored is not None
        which = np.searchsorted(self.everything.rows, rows)
        features = self._library.features
        grouping = narrow(Grouping(stored.centroids, stored.lists), features[rows], which)
        probes = self.lists.probes if self.lists else stored.probes
        return InvertedLists(self._schema, features, self._bias, rows, grouping, probes)


def _nothing(library: Library, text: str, satisfied: Flags) -> str:
    if satisfied.any():
        return (
            f"{text!r} holds only within the last second of clips, where no search may start; "
            "loosen it"
        )
    return f"nothing in library {library.name!r} satisfies {text!r}; loosen it"
