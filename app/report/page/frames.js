// The frames of an animation, played or chosen by a slider; the robot is drawn in the 3-D view at
// the pose of the frame.
'use strict';

/// The robot as it believes to be, and the way from there to where it truly is.
/// @param view3d as createView3d() gives it
function createRobot3d(view3d) {
  const robot = new THREE.Group();
  let ellipsoid = null, factor = 1;
  view3d.addLayer('robot', 'robot, with 3σ', cssColor('--ink'), robot);

  function scale() {
    if (ellipsoid) ellipsoid.scaleTo(3 * factor);
    view3d.requestRender();
  }

  function addTruth(truth, believed) {
    const mark = new THREE.Mesh(new THREE.SphereBufferGeometry(2.2 * view3d.thick, 20, 14),
                                new THREE.MeshLambertMaterial({color: kTruthColor, emissive: kTruthColor, emissiveIntensity: 0.3}));
    mark.position.copy(point3(truth));
    robot.add(mark, new THREE.Line(
        new THREE.BufferGeometry().setFromPoints([point3(believed), point3(truth)]),
        new THREE.LineBasicMaterial({color: kTruthColor})));
  }

  return {
    /// @param frame of the report; without a belief no robot is shown
    show({believed, truth, color}) {
      empty3d(robot);
      ellipsoid = null;
      if (believed) {
        const shapes = robotShapes(believed.T_w_c_rows, believed.position_covariance, color, view3d);
        ellipsoid = shapes.ellipsoid;
        robot.add(...shapes.all);
        if (truth) addTruth(truth, believed.position);
      }
      scale();
    },
    setExaggeration(wanted) {
      factor = wanted;
      scale();
    },
  };
}

/// The waypoint nearest to the robot of a picture; -1 for pictures that are not of the first path,
/// whose colour they would have.
function waypointOf({believed, color}) {
  if (!believed || !waypoints.length || color !== paths[0].color) return -1;
  const squared = ({position}) => position.reduce((sum, x, i) => sum + (x - believed.position[i]) ** 2, 0);
  return waypoints.reduce((best, {point}, i) => (squared(point) < squared(waypoints[best].point) ? i : best), 0);
}

/// @param view3d null without WebGL
/// @param onShow called with the waypoint of the picture that was chosen
/// @returns null without pictures
function createFrames(view3d, onShow) {
  element('frames').hidden = !data.frames.length;
  if (!data.frames.length) return null;
  const robot = view3d && data.frames.some(({believed}) => believed) ? createRobot3d(view3d) : null;
  const slider = element('frame-slider'), choice = element('frame-series');
  const names = [...new Set(data.frames.map(({series}) => series || ''))];
  let frames = [], places = [], isLeading = false;

  const shown = () => Number(slider.value);
  const draw = (index) => {
    const place = places[index], caption = frames[index].caption;
    slider.value = index;
    element('frame').src = frames[index].image;
    element('frame').alt = caption;
    element('frame-caption').textContent = `Picture ${index + 1} of ${frames.length}` +
        `${place < 0 ? '' : `, at ${placeName.toLowerCase()} ${place} of the path`}: ${caption}`;
    if (robot) robot.show(frames[index]);
    document.documentElement.dataset.frame = index;
  };
  const show = (index) => {
    draw(index);
    isLeading = true;
    onShow(places[index]);
    isLeading = false;
  };
  const player = createPlayer(element('play'), element('frame-speed'), 700, {
    isAtEnd: () => shown() + 1 >= frames.length,
    next: () => show(shown() + 1),
    rewind: () => show(0),
  });
  /// The tree of a plan is complete at the end; a flight begins.
  const choose = (name) => {
    player.stop();
    frames = data.frames.filter(({series}) => (series || '') === name);
    places = frames.map(waypointOf);
    slider.max = frames.length - 1;
    draw(data.result.command === 'plan' ? frames.length - 1 : 0);
  };
  slider.addEventListener('input', () => { player.stop(); show(shown()); });
  choice.hidden = names.length < 2;
  choice.append(...names.map((name) => make('option', name, {value: name})));
  choice.addEventListener('change', () => choose(choice.value));
  choose(names[0]);
  return {
    setExaggeration: (factor) => { if (robot) robot.setExaggeration(factor); },
    /// The waypoint of the picture; -1: none.
    place: () => places[shown()],
    /// Shows the picture nearest to a waypoint that was chosen elsewhere.
    follow(waypoint) {
      if (isLeading || places[0] < 0) return;
      player.stop();
      draw(places.reduce((best, place, i) =>
          Math.abs(place - waypoint) < Math.abs(places[best] - waypoint) ? i : best, 0));
    },
  };
}
