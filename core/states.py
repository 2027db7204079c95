"""States of an attractor, as kernels and arrays hold them: the values of `connectedness.Connectedness`."""

CONNECTED, DISCONNECTED, UNDECIDED, NO_ATTRACTOR = 0, 1, 2, 3
