"""What the laws of bus codecs are tested over."""

from __future__ import annotations

from hypothesis import strategies as st

SERVOS = st.integers(0, 252)
DATA = st.integers(1, 8).flatmap(
    lambda size: st.dictionaries(
        SERVOS,
        st.lists(st.sampled_from([0, 1, 0x55, 0xFD, 0xFE, 0xFF]), min_size=size, max_size=size).map(bytes),
        min_size=1,
        max_size=6,
    )
)
NOISE = st.lists(st.sampled_from([0x00, 0x01, 0x04, 0x55, 0xFD, 0xFF]), max_size=12).map(bytes)
