"""A binary heap of indices, as arrays that kernels share: the least key on top."""

from __future__ import annotations

from .kernels import njit


@njit(nogil=True, cache=True)
def sift_up(order, key, place):
    """Restore a heap of indices, least key on top, after its last entry changed."""
    while place > 0 and key[order[place]] < key[order[(place - 1) // 2]]:
        above = (place - 1) // 2
        order[place], order[above] = order[above], order[place]
        place = above


@njit(nogil=True, cache=True)
def sift_down(order, key, length):
    """Restore a heap of indices, least key on top, after its first entry changed."""
    place = 0
    while True:
        least = place
        for below in (2 * place + 1, 2 * place + 2):
            if below < length and key[order[below]] < key[order[least]]:
                least = below
        if least == place:
            return
        order[place], order[least] = order[least], order[place]
        place = least


@njit(nogil=True, cache=True)
def ascending(key, count, order, ranked):
    """Write into `ranked` the indices of the first `count` keys, least first; `order` is work space."""
    for k in range(count):
        order[k] = k
        sift_up(order, key, k)
    for length in range(count - 1, -1, -1):
        ranked[count - 1 - length] = order[0]
        order[0] = order[length]
        sift_down(order, key, length)
