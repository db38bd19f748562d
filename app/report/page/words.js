// Words and units of the keys of result.json, and the groups in which they are shown.
'use strict';

/// What stands elsewhere on the page, and explanations for readers of result.json.
const kShownElsewhere = ['config', 'schema', 'path', 'command', 'version', 'verdict', 'covariance_frame', 'directions_are',
  'trace_decimals', 'view.information_frame'];

const kPathKeys = ['length', 'metric_length', 'cost', 'length_share', 'uncertainty_share', 'mean_trace', 'goal_trace'];

/// The groups of a command, with their keys in order. Other keys are grouped by their objects.
const kGroups = {
  plan: {
    'Path': kPathKeys,
    'RRT*’s path (baseline)': kPathKeys.map((key) => `baseline.${key}`).concat('baseline.planner'),
    'Search': ['status', 'vertices', 'iterations', 'views', 'cache_hits', 'planner_cost', 'second_order_fallbacks'],
    'Time': ['time.total_s', 'time.views_s', 'time.beliefs_s', 'time.tree_s'],
    'Settings': ['planner', 'information', 'space', 'alpha', 'kappa', 'kappa_is_automatic', 'characteristic_length', 'seed'],
    'Check': ['audit.beliefs', 'audit.max_cost_error', 'audit.max_covariance_error'],
  },
  check: {
    'Trajectory': ['length', 'metric_length', 'mean_trace', 'goal_trace', 'least_clearance_m', 'collisions', 'out_of_bounds'],
    'Localisation': ['is_lost', 'lost', 'lost_m', 'rejected_images_m', 'open_directions_m'],
    'Settings': ['status', 'characteristic_length', 'seed'],
  },
  map: {'Settings': ['depth', 'resolution', 'min_range', 'max_range']},
  replay: {
    'Tracking': ['recorded', 'frames', 'tracked', 'degenerate', 'lost', 'unreadable', 'keyframes', 'depth_density', 'fps', 'fps_with_reading'],
    'Absolute error': ['judged', 'ate_rmse_m', 'ate_median_m', 'ate_max_m', 'ate_rotation_rmse_deg', 'ate_alignment', 'aligned_frame'],
    'Consistency': ['nees_per_dof', 'nees_median_per_dof', 'nees_position_per_dof.mean', 'nees_position_per_dof.median',
                    'nees_rotation_per_dof.mean', 'nees_rotation_per_dof.median', 'beyond_5_sigma', 'converged_beyond_5_sigma'],
  },
  sweep: {'Sweep': ['alphas', 'planners', 'kappa', 'runs_per_cell', 'first_seed', 'runs_asked', 'runs_done', 'shard', 'status']},
  explore: {
    'First flight': ['planner', 'arrived', 'end', 'reason', 'length', 'duration_s', 'goal_error_m', 'position_rmse_m', 'nees_per_dof',
                     'arrival_probability', 'least_clearance_m', 'collisions'],
    'Camera': ['images', 'keyframes', 'rejected_images', 'times_lost', 'lost_s', 'blind_steps'],
    'Work': ['status', 'flights_asked', 'flights_ended', 'wall_s', 'time.total_s', 'seed', 'kappa'],
  },
  servo: {'Goal': ['position_sigma_m', 'rotation_sigma_rad', 'condition', 'goal.depth_m', 'goal.position', 'goal.yaw']},
};

/// Titles of groups that are objects of result.json.
const kTitles = {
  dataset: 'Recording', voxels: 'Map', comparison: 'Comparison with the images', rpe: 'Relative error', options: 'Settings',
  flight: 'Settings of the flights', flights: 'Simulated flights', worst: 'Where the belief is least certain', servo: 'Settings of the servo',
  arrival: 'Arrival', with_best_headings: 'With the best headings',
};

/// Label and unit of keys, or of paths, whose own words do not say enough.
const kNames = {
  metric_length: ['Length with rotations counted', 'm'], length_share: ['Share of the length, with rotations, in the cost', '%'],
  uncertainty_share: ['Share of the uncertainty in the cost', '%'],
  goal_trace: ['Trace at the goal', 'm²'], trace_before_view: ['Trace before the view', 'm²'],
  information_trace: ['Trace of the information (1/m² and 1/rad², added)', ''],
  min_eigenvalue: ['Smallest eigenvalue of the information (units mixed)', ''],
  views: ['Views predicted', ''], cache_hits: ['Views taken from the cache', ''],
  planner_cost: ['Cost in the planner’s own model', ''],
  second_order_fallbacks: ['Second order in place of the fourth', ''],
  total_s: ['In total, without this report', 's'], views_s: ['Predicting views', 's'],
  beliefs_s: ['Propagating beliefs', 's'], tree_s: ['Growing the tree', 's'],
  information: ['Information model', ''], space: ['State space', ''],
  alpha: ['Alpha (1: only length counts)', ''], kappa: ['Kappa', '1/m²'], kappa_is_automatic: ['Kappa chosen automatically', ''],
  seed: ['Seed of the random numbers', ''], image_rate: ['Image rate', 'Hz'],
  max_cost_error: ['Largest error of a cost', ''], max_covariance_error: ['Largest error of a covariance', 'm²'],
  'audit.beliefs': ['Beliefs computed again', ''],
  lost_m: ['Length on which the camera is lost', 'm'], lost_s: ['Time without tracking', 's'],
  rejected_images_m: ['Length with rejected images', 'm'], open_directions_m: ['Length with open directions', 'm'],
  // Trajectories and flights.
  is_lost: ['Camera lost', ''], least_clearance_m: ['Least distance to an obstacle', 'm'], tilt_deg: ['Largest tilt of the body', '°'],
  has_heading: ['Headings given', ''], poses: ['Poses', ''], own_trace: ['Trace with its own heading', 'm²'],
  probability: ['Believed probability to be within the tolerance', '%'],
  arrival_probability: ['Believed probability of arrival', '%'], tolerance_m: ['Tolerance', 'm'],
  position_sigma_m: ['Position, 1σ', 'm'], rotation_sigma_rad: ['Rotation, 1σ', 'rad'],
  predicted_sigma_m: ['Position predicted by the plan, 1σ', 'm'], believed_sigma_m: ['Position estimated in flight, 1σ', 'm'],
  position_rmse_m: ['Position error, RMS', 'm'], within_predicted_3_sigma: ['Errors within 3 predicted σ', '%'],
  goal_error_m: ['True distance to the goal at the end', 'm'], nees_per_dof: ['NEES per degree of freedom (1: consistent)', ''],
  nees_median_per_dof: ['NEES per degree of freedom, median', ''], nees_at_goal_per_dof: ['NEES at the goal', ''],
  nees_at_goal_bounds: ['NEES at the goal, 95 % interval if consistent', ''],
  nees_median_flight_per_dof: ['NEES of the median flight', ''],
  astray: ['Wrong arrivals (estimate at the goal, robot elsewhere)', ''], uncertain_arrivals: ['Uncertain arrivals', ''],
  given_up: ['Gave up lost', ''], out_of_time: ['Out of time', ''], lost_track: ['Flights that lost track', ''],
  mean_speed_mps: ['Mean speed', 'm/s'], error_before_m: ['Error before servoing on the image of the goal', 'm'],
  error_after_m: ['Error after servoing on the image of the goal', 'm'],
  'photometric_goal.flights': ['Flights that servoed on the image of the goal', ''],
  'flights.photometric_goal.flights': ['Flights that servoed on the image of the goal', ''],
  blackout_s: ['Blackout, start and length', 's'], camera: ['Image noise', ''], camera_black_rate: ['Black images', '%'],
  camera_drop_rate: ['Images that never arrive', '%'], camera_latency_s: ['Delay of the images', 's'],
  camera_period_s: ['Time between images', 's'], drift_mps: ['Drift of the velocity, 1σ', 'm/s'],
  least_sigma: ['Least standard deviation of an alignment, position and rotation', 'm, rad'],
  scale: ['Factor on the information of an alignment', ''], max_speed_mps: ['Largest speed', 'm/s'],
  max_turn_rate_radps: ['Largest turn rate', 'rad/s'],
  odometry_factor: ['True odometry variance divided by the assumed one', ''], velocity_lag_s: ['Lag of the velocity', 's'],
  'flight.photometric_goal': ['Servoing on the image of the goal', ''], body_radius_m: ['Radius of the robot', 'm'],
  end: ['End of the flight', ''], reason: ['Reason', ''], length_m: ['Length', 'm'], wall_s: ['Computing time of the first flight', 's'],
  blind_steps: ['Steps without an image', ''], images: ['Images tracked', ''], rejected_images: ['Images rejected', ''],
  // Sweeps.
  alphas: ['Values of alpha', ''], runs_per_cell: ['Seeds per planner and alpha', ''], first_seed: ['First seed', ''],
  runs_asked: ['Runs planned', ''], runs_done: ['Runs done', ''], shard: ['Part of the work', ''],
  // Recordings.
  recorded: ['Frames of the recording', ''], used: ['Frames used', ''], every: ['Every n-th frame is used', ''],
  frames: ['Frames used', ''], tracked: ['Frames tracked', ''], lost: ['Lost', ''], degenerate: ['Frames with open directions', ''],
  unreadable: ['Frames unreadable', ''], judged: ['Tracked frames with a true pose', ''], black: ['Black frames', ''],
  skipped: ['Frames skipped', ''], depth_density: ['Pixels with depth', '%'], fps: ['Tracking', 'frames/s'],
  fps_with_reading: ['Tracking and reading images', 'frames/s'], ate_alignment: ['Alignment to the true path', ''],
  ate_rmse_m: ['Position, RMS', 'm'], ate_median_m: ['Position, median', 'm'], ate_max_m: ['Position, largest', 'm'],
  ate_rotation_rmse_deg: ['Rotation, RMS', '°'], aligned_frame: ['Placed at the true pose of frame', ''],
  beyond_5_sigma: ['Errors beyond 5σ', ''], converged_beyond_5_sigma: ['Errors of converged alignments beyond 5σ', ''],
  'nees_position_per_dof.mean': ['NEES of the position, mean', ''], 'nees_position_per_dof.median': ['NEES of the position, median', ''],
  'nees_rotation_per_dof.mean': ['NEES of the rotation, mean', ''], 'nees_rotation_per_dof.median': ['NEES of the rotation, median', ''],
  'mean.predicted': ['Pixels predicted', '%'], 'mean.contrast': ['Difference of the best uniform grey, mean', 'grey\u00a0values'],
  'mean.mean_abs_intensity': ['Difference of grey values, mean', 'grey\u00a0values'],
  'mean.median_abs_intensity': ['Difference of grey values, median', 'grey\u00a0values'],
  'mean.mean_abs_depth': ['Difference of depth, mean', 'm'], 'mean.median_abs_depth': ['Difference of depth, median', 'm'],
  'camera.assumed': ['Camera assumed', ''], 'camera.depth_registered_here': ['Depth registered to the image by photonav', ''],
  up: ['Upward direction of the recorded world', ''], up_direction: ['Upward direction as a vector', ''],
  tilt_degrees: ['Angle of the upward direction to the nearest axis', '°'], depth_scale: ['Depth image value of one metre', ''],
  depth: ['Depth', ''], resolution: ['Edge of a cell', 'm'], min_range: ['Nearest depth mapped', 'm'],
  max_range: ['Farthest depth mapped', 'm'], occupied: ['Occupied cells', ''], free: ['Free cells', ''],
  depth_error: ['Error of depth that repeats, share of the motion', '%'], depth_error_assumed: ['Error of depth assumed', ''],
  depth_noise_m: ['Noise of depth at 1 m, 1σ', 'm'], median_depth_m: ['Median depth', 'm'], layout: ['Layout of the files', ''],
  sigma: ['Image noise, 1σ', 'grey\u00a0values'], start_sigma: ['Start pose, 1σ', 'm, rad'], truth_sigma: ['True poses, 1σ', 'm, rad'], min_overlap: ['Least overlap with the map', '%'],
  exposure: ['Exposure estimated', ''], mode: ['Tracking by', ''], tolerance_s: ['Largest difference of timestamps', 's'],
  fuse_s: ['Fusing images into the map', 's'], fuse_per_frame_s: ['Fusing one image', 's'], compare_s: ['Comparing with the images', 's'],
  load_images_s: ['Loading images', 's'], read_s: ['Reading the recording', 's'], write_s: ['Writing the map', 's'],
  track_s: ['Tracking', 's'],
  // Servoing.
  condition: ['Condition of the Hessian', ''], depth_m: ['Median depth of the view', 'm'], damping: ['Damping', ''],
  degrees_of_freedom: ['Degrees of freedom', ''], gain: ['Gain', '1/s'], image_width: ['Width of the images', 'pixels'],
};

for (const [key, words] of [['cx', 'Principal point, x'], ['cy', 'Principal point, y'], ['fx', 'Focal length, x'],
                            ['fy', 'Focal length, y'], ['width', 'Width of the images'], ['height', 'Height of the images']])
  kNames[`camera.${key}`] = [words, 'pixels'];

for (const [span, over] of [['frame', 'a frame'], ['second', 'a second'], ['metre', 'a metre']])
  for (const [key, words, unit] of [
    ['translation_m', 'position, RMS', 'm'], ['median_translation_m', 'position, median', 'm'], ['p90_translation_m', 'position, 90th percentile', 'm'],
    ['rotation_deg', 'rotation, RMS', '°'], ['median_rotation_deg', 'rotation, median', '°'], ['p90_rotation_deg', 'rotation, 90th percentile', '°'],
    ['pairs', 'pairs of frames', '']])
    kNames[`rpe.${span}.${key}`] = [`Over ${over}: ${words}`, unit];

/// Units of ends of keys. An end with an underscore is no part of the label.
const kUnits = {
  _s: 's', _per_s: '1/s', _ms: 'ms', _m: 'm', _cm: 'cm', _m2: 'm²', _mps: 'm/s', _rad: 'rad', _deg: '°', _degrees: '°',
  length: 'm', distance: 'm', resolution: 'm', range: 'm', position: 'm', trace: 'm²', yaw: 'rad',
};

const kWords = {
  nees: 'NEES', ate: 'ATE', rpe: 'RPE', rmse: 'RMS error', std: 'standard deviation', dof: 'degree of freedom',
  fps: 'frames per second', p90: '90th percentile of',
  xyz: 'position', 'xyz_yaw': 'position and heading', se3: 'position and rotation',
};
