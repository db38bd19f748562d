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
    """Columns of an image."""
    height: int
    """Rows of an image."""
    fx: float
    """Focal length along x [pixels]."""
    fy: float
    """Focal length along y [pixels]."""
    cx: float
    """Principal point, column [pixels]."""
    cy: float
    """Principal point, row [pixels]."""

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
    def load(file: Union[str, "PathLike[str]"]) -> "Map":
        """Reads a textured OctoMap (.ot), as save() and `photonav map` write it."""
    def save(self, file: Union[str, "PathLike[str]"]) -> None:
        """Writes the map as an OctoMap file (.ot); an existing file is replaced."""
    def fuse(
        self, image: ArrayLike, depth: ArrayLike, camera: Camera, T_c_w: ArrayLike, max_range: float = 4.0
    ) -> int:
        """Adds an image with depth taken at a pose. Returns in how many bricks of 4^3 cells
        occupancy changed.

        image: grey values in [0, 1], or uint8, which is divided by 255. depth: [m], 0: no surface.
        """
    def occupied(self) -> tuple[Array, Image]:
        """Centres (N, 3) and mean grey values (N,) of the occupied cells; NaN: never observed."""
    def views(self) -> Views:
        """A snapshot to render views from; later changes of the map do not change it."""
    @property
    def resolution(self) -> float:
        """Edge of a cell [m]."""

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

    image: grey values in [0, 1], or uint8, which is divided by 255. depth: [m], 0: no surface.
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
    """What every pixel adds to the information about a direction (6,), or about all together.

    image and depth: as for information().
    """

def exp_se3(xi: ArrayLike) -> Array:
    """The rigid motion (4, 4) of a twist (6,): translation [m], then rotation [rad]."""

def log_se3(T: ArrayLike) -> Array:
    """The twist (6,) of a rigid motion (4, 4), of at most half a turn: the inverse of exp_se3()."""

def adjoint(T: ArrayLike) -> Array:
    """Ad(T) (6, 6), which maps twists between frames: T exp(xi) T^-1 = exp(Ad(T) xi)."""

def compound(
    T_c_b: ArrayLike, motion: ArrayLike, T_b_a: ArrayLike, covariance: ArrayLike
) -> tuple[Array, Array]:
    """T_c_a = T_c_b T_b_a with its covariance, to fourth order (Barfoot and Furgale 2014)."""

def update(covariance: ArrayLike, information: ArrayLike) -> Array:
    """Covariance after a measurement: (information + covariance^-1)^-1, also for singular ones."""

class Path:
    """A path with the beliefs along it; the arrays have a row for every point."""

    planner: str
    """Name of the planner; given: of beliefs()."""
    cost: float
    """Cost J, which planners minimise."""
    length: float
    """Length [m]."""
    mean_trace: float
    """Weighted trace of the covariance, averaged over the distance flown [m^2]."""
    goal_trace: float
    """Weighted trace of the covariance at the goal [m^2]."""
    length_share: float
    """Share of the length in the cost, in [0, 1]."""
    T_w_b: Array
    """Poses of the body in the world (N, 4, 4)."""
    covariance: Array
    """Of T_c_w after the view (N, 6, 6), camera frame: translation, then rotation."""
    information: Array
    """Fisher information of the view (N, 6, 6), camera frame."""
    trace: Array
    """Weighted trace of the covariance (N,) [m^2]."""
    distance: Array
    """Length of the path so far (N,) [m]."""
    is_waypoint: NDArray[np.bool_]
    """Whether a point is a waypoint of the planner (N,)."""
    @property
    def positions(self) -> Array:
        """Positions of the body (N, 3) [m]."""
    @property
    def yaw(self) -> Array:
        """Headings (N,) [rad]."""
    @property
    def position_sigma(self) -> Array:
        """Standard deviation of the position along its weakest direction (N,) [m]."""

class Plan:
    """What a planner found."""

    status: str
    """done, no path, or failed (its cost is not finite)."""
    path: Optional[Path]
    """The best path; None if there is none."""
    alpha: float
    """Weight of the length in the cost."""
    vertices: int
    """Number of vertices of the tree."""
    views: int
    """Number of views rendered."""
    seconds: float
    """Duration of the planning [s]."""
    tree: Image
    """Edges of the tree: both ends of each (N, 2, 3) [m]."""

class Problem:
    """A planning problem: a config, its world, and what can be asked about it."""

    def __init__(self, config: Config, overrides: Sequence[str] = ()) -> None:
        """config: a YAML file, or a dictionary of the same keys, whose paths are relative to the
        working directory. overrides: "key.path=value"."""
    @property
    def config(self) -> str:
        """The complete config as YAML."""
    @property
    def camera(self) -> Camera:
        """The camera of the config."""
    @property
    def views(self) -> Views:
        """The scene or map of the config, to render views from."""
    @property
    def T_b_c(self) -> Array:
        """Pose of the camera on the body (4, 4)."""
    @property
    def initial_covariance(self) -> Array:
        """Of T_c_w at the start before any view (6, 6), camera frame."""
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
