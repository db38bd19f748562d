# SPDX-License-Identifier: BSD-3-Clause
"""Perception-aware path planning: what an image is worth, and paths along which it is worth enough.

Poses are 4x4 arrays: T_a_b maps coordinates in b to coordinates in a. Frames: w world (x forward,
y left, z up), b body (the same axes), c camera (x right, y down, z forward). Units are metres,
radians, seconds; grey values are in [0, 1]. Twists and the rows of 6x6 arrays are ordered
(translation, rotation). A belief of a camera pose is T_c_w = exp(xi) mean, xi ~ N(0, covariance)
in the camera frame.

Long calls release the interpreter's lock, and Ctrl-C ends them with KeyboardInterrupt.
"""

from photonav._photonav import *  # noqa: F401,F403
from photonav._photonav import __version__  # noqa: F401
