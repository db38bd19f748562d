// A flight in the 3-D view: the map as it was then, the planner's tree, its path and beliefs, the
// path flown and the robot.
'use strict';

/// @param view3d as createView3d() gives it
/// @returns {cubes(), showMoment(index), showRobot(pose), showWay(points), setExaggeration(factor)}
function createFlight3d(view3d, flight) {
  const {header} = flight;
  const cubes = new Cubes(header.cell, view3d.hidden);
  const slots = new Map();  // of cells: number of the cube
  let mapped = -1;          // moment that the cubes are of
  let exaggeration = 1;

  const group = () => new THREE.Group();
  const [tree, plan, beliefs, robot] = [group(), group(), group(), group()];
  const way = lineOf(header.color), trueWay = lineOf(kTruthColor);

  function lineOf(color) {
    const line = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({color}));
    line.frustumCulled = false;
    line.renderOrder = 3;
    return line;
  }

  view3d.addLayer('map', 'map so far', '#9aa3ae', cubes.mesh);
  view3d.addLayer('tree', 'tree', '#268c7a', tree);
  view3d.addLayer('plan', `plan, ${header.planner}`, header.color, plan);
  view3d.addLayer('ellipsoids', '3σ of the plan', header.color, beliefs);
  view3d.addLayer('way', 'believed path', header.color, way);
  view3d.addLayer('truth', 'true path', kTruthColor, trueWay);
  view3d.addLayer('robot', 'robot, with 3σ', cssColor('--ink'), robot);

  // Map -----------------------------------------------------------------------------------------
  const kGone = 255;
  const keyOf = (i, j, k) => ((i + 32768) * 65536 + (j + 32768)) * 65536 + (k + 32768);
  const lastCube = [];  // keys by number, to move the last one

  function applyCells({cells, greys}) {
    greys.forEach((grey, n) => {
      const [i, j, k] = cells.subarray(3 * n, 3 * n + 3), key = keyOf(i, j, k);
      const slot = slots.get(key);
      if (grey !== kGone && slot !== undefined) {
        cubes.greys[slot] = grey;
      } else if (grey !== kGone) {
        const centre = (index) => (index + 0.5) * header.cell;
        slots.set(key, cubes.add(centre(i), centre(j), centre(k), grey));
        lastCube.push(key);
      } else if (slot !== undefined) {
        cubes.remove(slot);
        slots.delete(key);
        const moved = lastCube.pop();
        if (moved !== key) {
          slots.set(moved, slot);
          lastCube[slot] = moved;
        }
      }
    });
  }

  function showMap(index) {
    if (index < mapped) {  // from the beginning: changes are known forward only
      slots.clear();
      lastCube.length = cubes.count = 0;
      mapped = -1;
    }
    while (mapped < index) applyCells(flight.moments[++mapped]);
    cubes.commit();
  }

  // Tree, plan, beliefs ----------------------------------------------------------------------------
  let shownTree = null;
  function showTree(edges) {
    if (edges === shownTree) return;
    shownTree = edges;
    empty3d(tree);
    if (!edges) return;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(edges, 3));
    tree.add(new THREE.LineSegments(geometry, new THREE.LineBasicMaterial(
        {color: '#268c7a', transparent: true, opacity: 0.45})));
  }

  const ellipsoids = () => beliefs.children;
  function showPlan(points) {
    empty3d(plan);
    empty3d(beliefs);
    const tube = tubeAlong(points.map((point) => point.position), view3d.thick, header.color);
    if (tube) plan.add(tube);
    const every = Math.ceil(points.length / 20);
    points.forEach((point, i) => {
      if (i % every !== 0 && i + 1 < points.length) return;
      beliefs.add(new Ellipsoid(new THREE.MeshLambertMaterial(
          {color: header.color, transparent: true, opacity: 0.22, depthWrite: false}),
          point.position, point.covariance));
    });
  }

  function scaleEllipsoids() {
    for (const ellipsoid of ellipsoids()) ellipsoid.scaleTo(3 * exaggeration);
    for (const part of robot.children) if (part.scaleTo) part.scaleTo(3 * exaggeration);
    view3d.requestRender();
  }

  // Robot ------------------------------------------------------------------------------------------
  function showRobot({rows, covariance}) {
    empty3d(robot);
    robot.add(...robotShapes(rows, covariance, cssColor('--ink'), view3d).all);
    scaleEllipsoids();
  }

  function setLine(line, positions) {
    line.geometry.dispose();
    line.geometry = new THREE.BufferGeometry();
    line.geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
  }

  cubes.commit();
  return {
    cubes: () => cubes.count,
    showMoment(index) {
      showMap(index);
      showTree(flight.latest('tree', index));
      showPlan(flight.moments[index].plan);
      scaleEllipsoids();
    },
    showRobot,
    /// @param points flown until then
    showWay(points) {
      setLine(way, points.flatMap((point) => point.believed));
      setLine(trueWay, points.flatMap((point) => point.truth));
      view3d.requestRender();
    },
    setExaggeration(factor) {
      exaggeration = factor;
      scaleEllipsoids();
    },
  };
}
