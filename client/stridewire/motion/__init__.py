"""The motion kernel: arrays in, arrays out.

Conventions, here and everywhere: metres, seconds, radians; Y up, right-handed, a character looks
along +Z and its left is +X; quaternions w, x, y, z, unit, local rotations relative to the parent;
batch first `(N, J, 4)`, in clips time first `(T, J, 4)`; parents precede their children and the
hips come first.
"""
