# SPDX-License-Identifier: BSD-3-Clause
from os import PathLike
from typing import Any, Callable, Mapping, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str

Array = NDArray[np.float64]
Image = NDArray[np.float32]
Config = Union[str, "PathLike[str]", Mapping[str, Any]]
Place = Sequence[float]

class InputError(ValueError):
    """A file, option or value that cannot be used; the message is "FILE: KEY: REASON"."""

class Camera:
    """An undistorted pinhole camera with square pixels and the principal point in its centre."""

    def __init__(self, width: int = 188, height: int = 120, hfov: float = 70.0) -> None:
        """hfov: horizontal field of view in degrees."""
    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float

class Views:
    """A scene, mesh or map from which views are rendered."""

    @staticmethod
    def load(file: Union[str, "PathLike[str]"]) -> "Views":
        """A scene (.yaml), a mesh (.glb, .obj, .ply) or a textured OctoMap (.ot, .bt)."""
    @property
    def cell_size(self) -> float:
        """Of the cells of a map [m]; 0 for scenes and meshes."""
    def render(self, camera: Camera, T_c_w: ArrayLike) -> tuple[Image, Image]:
        """Noise-free image in [0, 1] and depth [m] (0: no surface), both (height, width)."""

class Map:
    """A textured OctoMap, made image by image."""

    def __init__(self, resolution: float = 0.05) -> None: ...
    @staticmethod
    def load(file: Union[str, "PathLike[str]"]) -> "Map": ...
    def save(self, file: Union[str, "PathLike[str]"]) -> None: ...
    def fuse(
        self, image: ArrayLike, depth: ArrayLike, camera: Camera, T_c_w: ArrayLike, max_range: float = 4.0
    ) -> int:
        """Adds an image with depth taken at a pose. Returns in how many bricks of 4^3 cells
        occupancy changed."""
    def occupied(self) -> tuple[Array, Image]:
        """Centres (N, 3) and mean grey values (N,) of the occupied cells; NaN: never observed."""
    def views(self) -> Views:
        """A snapshot to render views from; later changes of the map do not change it."""
    @property
    def resolution(self) -> float: ...

def camera_pose(position: ArrayLike, yaw: float = 0.0, mount: Union[str, float] = "down") -> Array:
    """T_c_w of a camera on a level body at a position [m] with a heading [rad].

    mount: down, front45, forward or degrees below the horizon.
    """

def information(
    image: ArrayLike,
    depth: ArrayLike,
    camera: Camera,
    sigma: float = 0.02,
    scale: float = 0.08,
    stride: int = 1,
) -> Array:
    """Fisher information (6, 6) of the camera pose from one image with depth, camera frame.

    image must be predicted or noise-free: gradients of noise look like information. sigma:
    standard deviation of the image noise. scale: factor, since neighbouring pixels are not
    independent: that of a config (camera.information_scale).
    """

def contribution(
    image: ArrayLike,
    depth: ArrayLike,
    camera: Camera,
    direction: Optional[ArrayLike] = None,
    sigma: float = 0.02,
    scale: float = 0.08,
) -> Image:
    """What every pixel adds to the information about a direction (6,), or about all together."""

def exp_se3(xi: ArrayLike) -> Array: ...
def log_se3(T: ArrayLike) -> Array: ...
def adjoint(T: ArrayLike) -> Array: ...
def compound(
    T_c_b: ArrayLike, motion: ArrayLike, T_b_a: ArrayLike, covariance: ArrayLike
) -> tuple[Array, Array]:
    """T_c_a = T_c_b T_b_a with its covariance, to fourth order (Barfoot and Furgale 2014)."""

def update(covariance: ArrayLike, information: ArrayLike) -> Array:
    """Covariance after a measurement: (information + covariance^-1)^-1, also for singular ones."""

class Path:
    """A path with the beliefs along it; the arrays have a row for every point."""

    planner: str
    cost: float
    length: float
    mean_trace: float
    goal_trace: float
    length_share: float
    T_w_b: Array
    covariance: Array
    information: Array
    trace: Array
    distance: Array
    is_waypoint: NDArray[np.bool_]
    @property
    def positions(self) -> Array:
        """Of the body (N, 3) [m]."""
    @property
    def yaw(self) -> Array:
        """Headings (N,) [rad]."""
    @property
    def position_sigma(self) -> Array:
        """Standard deviation of the position along its weakest direction (N,) [m]."""

class Plan:
    """What a planner found."""

    status: str
    path: Optional[Path]
    alpha: float
    vertices: int
    views: int
    seconds: float
    tree: Image

class Problem:
    """A planning problem: a config, its world, and what can be asked about it."""

    def __init__(self, config: Config, overrides: Sequence[str] = ()) -> None:
        """config: a YAML file, or a dictionary of the same keys, whose paths are relative to the
        working directory. overrides: "key.path=value"."""
    @property
    def config(self) -> str:
        """The complete config as YAML."""
    @property
    def camera(self) -> Camera: ...
    @property
    def views(self) -> Views: ...
    @property
    def T_b_c(self) -> Array: ...
    @property
    def initial_covariance(self) -> Array:
        """Of T_c_w at the start before any view, camera frame."""
    def kappa(self) -> float:
        """Of the cost [1/m^2]; chosen when it is needed first where the config says auto."""
    def clearance(self, position: ArrayLike) -> float:
        """Distance to the nearest obstacle [m]."""
    def information_at(self, position: ArrayLike, yaw: float = 0.0) -> Array:
        """Of the view from a place, as planners count it (cached by cells), camera frame."""
    def beliefs(self, path: ArrayLike) -> Path:
        """Along straight motions between places (N, 3) or, with headings, (N, 4)."""
    def plan(
        self,
        planner: Optional[str] = None,
        seed: Optional[int] = None,
        on_progress: Optional[Callable[[int, float], None]] = None,
    ) -> Plan:
        """on_progress(vertices, best cost) is called now and then."""
    def fly(
        self,
        path: Union[Path, Plan],
        flights: int = 1,
        jobs: int = 1,
        on_flight: Optional[Callable[[int], None]] = None,
    ) -> dict[str, Any]:
        """Flies a path in closed loop with the camera, noise and tracker of the config.

        on_flight(number done) is called after every flight. Returns counts (arrived, astray,
        collisions, lost, ...), errors and NEES; flights: a list with the end, duration and errors
        of each, its true and believed camera positions (N, 3) and times (N,).
        """

def replay(dataset: Union[str, "PathLike[str]"], **options: Any) -> dict[str, Any]:
    """Tracks a recorded flight: result.json of `photonav replay` as a dictionary, and the arrays
    time (N,), T_c_w (N, 4, 4) and covariance (N, 6, 6) of the tracked frames.

    options: the keys of `photonav keys --of replay`, such as map="map.ot" or odometry=True.
    """
