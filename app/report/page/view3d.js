// The orbitable 3-D view. It draws when something changed and rests otherwise. World: z up.
'use strict';

/// @param onPick called with the index of a waypoint that was clicked
function createView3d(canvas, onPick) {
  const attributes = {antialias: true, preserveDrawingBuffer: true};
  const context = canvas.getContext('webgl2', attributes) || canvas.getContext('webgl', attributes);
  if (!context) return null;
  const renderer = new THREE.WebGLRenderer({canvas, context, ...attributes});
  renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
  renderer.localClippingEnabled = true;

  const scene = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(40, 1, 0.01, 1000);
  camera.up.set(0, 0, 1);
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.enableKeys = false;   // the arrow keys walk along the path
  controls.enableZoom = false;   // the wheel scrolls the page until the view is clicked
  controls.screenSpacePanning = true;
  controls.maxPolarAngle = Math.PI / 2;  // from below, the floor hides everything
  scene.add(new THREE.AmbientLight(0xffffff, 0.75));
  const sun = new THREE.DirectionalLight(0xffffff, 0.45);
  sun.position.set(0.4, -0.7, 1.5);
  scene.add(sun);

  const layers = {};  // name: {label, color, object}
  let waiting = 0;    // textures that are still being decoded
  let frame = 0;

  function render() {
    frame = 0;
    const distance = camera.position.distanceTo(controls.target);
    camera.near = Math.max(extent / 2000, distance - 2 * extent);
    camera.far = distance + 4 * extent;
    camera.updateProjectionMatrix();
    map.hideNearWalls(camera.position);
    renderer.render(scene, camera);
    if (waiting === 0) publishColors();
  }
  function requestRender() {
    if (!frame) frame = requestAnimationFrame(render);
  }
  controls.addEventListener('change', requestRender);

  /// How many colours the first complete picture has, for the test that it is not blank.
  function publishColors() {
    const published = document.documentElement.dataset;
    if (published.canvas) return;
    const copy = document.createElement('canvas');
    copy.width = copy.height = 96;
    const pen = copy.getContext('2d');
    pen.drawImage(canvas, 0, 0, 96, 96);
    const colors = new Set(new Uint32Array(pen.getImageData(0, 0, 96, 96).data.buffer));
    published.colors = colors.size;
    published.canvas = colors.size > 8 ? 'drawn' : 'blank';
  }

  function addLayer(name, label, color, object) {
    layers[name] = {label, color, object};
    scene.add(object);
  }

  function textureFrom(uri) {
    const texture = new THREE.Texture();
    const image = new Image();
    ++waiting;
    image.onload = image.onerror = () => {
      texture.image = image;
      texture.needsUpdate = image.naturalWidth > 0;
      --waiting;
      requestRender();
    };
    image.src = uri;
    texture.flipY = false;  // v runs downward
    texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
    texture.anisotropy = renderer.capabilities.getMaxAnisotropy();
    return texture;
  }

  const map = createMap3d(textureFrom);

  // Sizes ---------------------------------------------------------------------------------------
  const box = map.box.clone();
  for (const path of paths) for (const point of path.points) box.expandByPoint(point3(point.position));
  if (box.isEmpty()) box.set(new THREE.Vector3(-1, -1, 0), new THREE.Vector3(1, 1, 1));
  const extent = Math.max(0.1, box.getSize(new THREE.Vector3()).length());
  const thick = 0.0024 * extent;

  // Ground grid with metres ---------------------------------------------------------------------
  const labels = [];
  /// Words at a place, `pixels` high whatever the distance.
  function label(text, color, position, pixels) {
    const sheet = document.createElement('canvas');
    const pen = sheet.getContext('2d');
    const font = '600 44px system-ui, "DejaVu Sans", sans-serif';
    pen.font = font;
    sheet.width = Math.ceil(pen.measureText(text).width) + 16;
    sheet.height = 60;
    pen.font = font;
    pen.fillStyle = color;
    pen.textBaseline = 'middle';
    pen.fillText(text, 8, 32);
    const texture = new THREE.CanvasTexture(sheet);
    texture.minFilter = THREE.LinearFilter;
    const sprite = new THREE.Sprite(new THREE.SpriteMaterial(
        {map: texture, sizeAttenuation: false, depthTest: false, transparent: true}));
    sprite.position.copy(position);
    sprite.renderOrder = 5;
    labels.push({sprite, pixels, aspect: sheet.width / sheet.height});
    return sprite;
  }

  const raw = Math.max(box.max.x - box.min.x, box.max.y - box.min.y, 0.1) / 10;
  const decade = 10 ** Math.floor(Math.log10(raw));
  const gridStep = [1, 2, 5, 10].map((n) => n * decade).find((step) => step >= 0.99 * raw);
  const low = [0, 1].map((i) => Math.floor(box.min.getComponent(i) / gridStep - 0.3));
  const high = [0, 1].map((i) => Math.ceil(box.max.getComponent(i) / gridStep + 0.3));
  let ground = new THREE.Group();

  function drawGround() {
    scene.remove(ground);
    ground.children.forEach((child) => {
      const at = labels.findIndex(({sprite}) => sprite === child);
      if (at >= 0) labels.splice(at, 1);
    });
    ground = new THREE.Group();
    const z = box.min.z - 0.001 * extent, quiet = cssColor('--quiet');
    const points = [];
    for (let i = low[0]; i <= high[0]; ++i) {
      points.push(i * gridStep, low[1] * gridStep, z, i * gridStep, high[1] * gridStep, z);
      if ((i - low[0]) % 2 === 1)
        ground.add(label(say(i * gridStep), quiet,
            new THREE.Vector3(i * gridStep, (low[1] - 0.35) * gridStep, z), 19));
    }
    for (let j = low[1]; j <= high[1]; ++j) {
      points.push(low[0] * gridStep, j * gridStep, z, high[0] * gridStep, j * gridStep, z);
      if ((j - low[1]) % 2 === 1)
        ground.add(label(say(j * gridStep), quiet,
            new THREE.Vector3((low[0] - 0.35) * gridStep, j * gridStep, z), 19));
    }
    ground.add(label('x [m]', cssColor('--ink'),
        new THREE.Vector3((high[0] + 1.5) * gridStep, (low[1] - 0.3) * gridStep, z), 22));
    ground.add(label('y [m]', cssColor('--ink'),
        new THREE.Vector3((low[0] - 0.3) * gridStep, (high[1] + 1.5) * gridStep, z), 22));
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(points, 3));
    ground.add(new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({color: cssColor('--grid')})));
    scene.add(ground);
    scene.background = new THREE.Color(cssColor('--sky'));
    scaleLabels();
  }

  // Search, paths, beliefs ----------------------------------------------------------------------
  function addTrees() {
    data.trees.forEach((tree, i) => {
      if (!tree.edges) return;
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.BufferAttribute(floatsOf(tree.edges), 3));
      addLayer(`tree${i}`, tree.name, tree.color, new THREE.LineSegments(geometry,
          new THREE.LineBasicMaterial({color: tree.color, transparent: true, opacity: 0.5})));
    });
  }

  function addPath(path, i) {
    const group = new THREE.Group();
    const tube = tubeAlong(path.points.map((point) => point.position), thick, path.color);
    if (tube) group.add(tube);
    addLayer(`path${i}`, path.name, path.color, group);
  }

  /// The paths of a sweep: one is chosen, the others are thin beside it.
  const chosenPaths = new THREE.Group(), otherPaths = new THREE.Group();
  function addAlternatives() {
    for (const path of paths) {
      const positions = path.points.map((point) => point.position);
      for (const [group, radius] of [[chosenPaths, 1.3 * thick], [otherPaths, 0.35 * thick]])
        group.add(tubeAlong(positions, radius, path.color) || new THREE.Group());
    }
    addLayer('chosen', 'path of the chosen alpha', cssColor('--ink'), chosenPaths);
    addLayer('others', 'other values of alpha', '#8b93a0', otherPaths);
  }

  /// Shows one of the alternatives with its ellipsoids.
  function choose(index) {
    const showOnly = (group, isShown) => group.children.forEach((child, i) => { child.visible = isShown(i); });
    showOnly(chosenPaths, (i) => i === index);
    showOnly(otherPaths, (i) => i !== index);
    if (layers.ellipsoids) showOnly(layers.ellipsoids.object, (i) => i === index);
    requestRender();
  }

  const ellipsoids = [];
  function addEllipsoids() {
    const group = new THREE.Group();  // a group per path
    for (const path of paths) {
      const ofPath = new THREE.Group();
      group.add(ofPath);
      const material = new THREE.MeshLambertMaterial(
          {color: path.color, transparent: true, opacity: 0.22, depthWrite: false});
      const step = path.points[path.points.length - 1].distance / 30;
      let next = 0;
      path.points.forEach((point, i) => {
        if (point.distance < next - 1e-9 && i + 1 < path.points.length) return;
        next = point.distance + step;
        ellipsoids.push(new Ellipsoid(material, point.position, point.position_covariance));
        ofPath.add(ellipsoids[ellipsoids.length - 1]);
      });
    }
    addLayer('ellipsoids', '3σ ellipsoids', '#8b93a0', group);
  }

  function setExaggeration(factor) {
    for (const ellipsoid of ellipsoids) ellipsoid.scaleTo(3 * factor);
    requestRender();
  }

  // Cameras -------------------------------------------------------------------------------------
  function addFrusta() {
    const every = Math.ceil(waypoints.length / 40);
    const lines = waypoints.filter((_, i) => i % every === 0)
        .flatMap((waypoint) => frustumLines(waypoint.point.T_w_c_rows, 0.02 * extent));
    addLayer('cameras', 'cameras', '#3f4b59', new THREE.LineSegments(
        new THREE.BufferGeometry().setFromPoints(lines),
        new THREE.LineBasicMaterial({color: cssColor('--quiet'), transparent: true, opacity: 0.8})));
  }

  // Waypoints -----------------------------------------------------------------------------------
  const spheres = [];
  const selection = new THREE.Group();
  function addWaypoints() {
    const ball = new THREE.SphereBufferGeometry(1, 20, 14);
    for (const {point} of waypoints) {
      const mesh = new THREE.Mesh(ball, new THREE.MeshLambertMaterial({color: 0xffffff, emissive: 0x555555}));
      mesh.position.copy(point3(point.position));
      mesh.scale.setScalar(1.9 * thick);
      spheres.push(mesh);
      layers.path0.object.add(mesh);
    }
    scene.add(selection);
  }
  function addMarker(text, position, color) {
    const mesh = new THREE.Mesh(new THREE.SphereBufferGeometry(3.2 * thick, 24, 16),
                                new THREE.MeshLambertMaterial({color, emissive: color, emissiveIntensity: 0.12}));
    mesh.position.copy(point3(position));
    const name = label(text, color, mesh.position, 26);
    name.center.set(0.5, -0.35);  // above the marker, from wherever one looks
    scene.add(mesh, name);
  }

  function select(index) {
    const waypoint = waypoints[index];
    spheres.forEach((mesh, i) => {
      mesh.scale.setScalar((i === index ? 3.2 : 1.9) * thick);
      mesh.material.color.set(i === index ? paths[0].color : '#ffffff');
    });
    selection.remove(...selection.children);
    const depth = 0.075 * extent;
    selection.add(new THREE.LineSegments(
        new THREE.BufferGeometry().setFromPoints(frustumLines(waypoint.point.T_w_c_rows, depth)),
        new THREE.LineBasicMaterial({color: cssColor('--ink')})));
    if (waypoint.view && waypoint.view.image) {
      waypoint.texture = waypoint.texture || textureFrom(waypoint.view.image);
      selection.add(imagePlane(waypoint.point.T_w_c_rows, depth, waypoint.texture));
    }
    requestRender();
  }

  /// The waypoint nearest to a place on the canvas, at most 24 pixels away.
  function waypointAt(event) {
    const frameBox = canvas.getBoundingClientRect();
    let best = -1, bestDistance = 24;
    waypoints.forEach(({point}, i) => {
      const seen = point3(point.position).project(camera);
      const distance = Math.hypot((seen.x + 1) / 2 * frameBox.width - (event.clientX - frameBox.left),
                                  (1 - seen.y) / 2 * frameBox.height - (event.clientY - frameBox.top));
      if (seen.z < 1 && distance < bestDistance) { best = i; bestDistance = distance; }
    });
    return best;
  }

  let pressed = null;
  canvas.addEventListener('pointerdown', (event) => { pressed = event; controls.enableZoom = true; });
  canvas.addEventListener('pointerleave', () => { controls.enableZoom = false; });
  canvas.addEventListener('pointermove', (event) => {
    if (!event.buttons) canvas.classList.toggle('hit', waypointAt(event) >= 0);
  });
  canvas.addEventListener('pointerup', (event) => {
    const still = pressed && Math.hypot(event.clientX - pressed.clientX, event.clientY - pressed.clientY) < 5;
    const hit = still ? waypointAt(event) : -1;
    if (hit >= 0) onPick(hit);
  });

  // Looking at it -------------------------------------------------------------------------------
  /// What has to be seen: the box, and the grid with its labels.
  const corners = [...Array(8).keys()].map((i) => i & 4
      ? new THREE.Vector3(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, box.max.z)
      : new THREE.Vector3(((i & 1 ? high : low)[0] + (i & 1 ? 1.2 : -0.6)) * gridStep,
                          ((i & 2 ? high : low)[1] + (i & 2 ? 1.2 : -0.6)) * gridStep, box.min.z));

  /// Looks from a direction, from where everything fits. The view turns about the middle of the box,
  /// and the picture is moved so that it fills the canvas.
  /// @param fov vertical field of view [degrees]; a small one is nearly an orthographic projection
  function lookFrom(direction, fov) {
    camera.fov = fov;
    const back = direction.clone().normalize();
    const right = new THREE.Vector3().crossVectors(camera.up, back).normalize();
    const up = new THREE.Vector3().crossVectors(back, right);
    const {clientWidth: width, clientHeight: height} = canvas.parentElement;
    const tanV = Math.tan(THREE.Math.degToRad(camera.fov / 2)), tanH = tanV * camera.aspect;
    const target = box.getCenter(new THREE.Vector3());
    const seen = corners.map((corner) => corner.clone().sub(target));
    /// Least and largest place across the picture; 1 and -1 are its borders.
    const range = (distance, axis, tan) => {
      const places = seen.map((c) => c.dot(axis) / (distance - c.dot(back)) / tan);
      return [Math.min(...places), Math.max(...places)];
    };
    const half = ([least, largest]) => (largest - least) / 2;
    let near = Math.max(...seen.map((c) => c.dot(back))), far = 100 * extent;
    for (let i = 0; i < 50; ++i) {
      const distance = (near + far) / 2;
      const fits = half(range(distance, right, tanH)) < 1 / (1.05 + 60 / width) &&
                   half(range(distance, up, tanV)) < 1 / (1.05 + 30 / height);
      if (fits) far = distance; else near = distance;
    }
    const middle = (axis, tan) => range(far, axis, tan).reduce((a, b) => a + b) / 2;
    camera.setViewOffset(width, height, middle(right, tanH) * width / 2, -middle(up, tanV) * height / 2, width, height);
    controls.target.copy(target);
    camera.position.copy(target).addScaledVector(back, far);
    controls.update();
    scaleLabels();
  }
  const views = {
    perspective: () => lookFrom(new THREE.Vector3(-0.55, -1, 0.85), 40),
    top: () => lookFrom(new THREE.Vector3(0, -1e-3, 1), 5),
  };

  function setCut(height) {
    map.setCut(height);
    requestRender();
  }

  function scaleLabels() {
    const perPixel = 2 * Math.tan(THREE.Math.degToRad(camera.fov / 2)) / canvas.parentElement.clientHeight;
    for (const {sprite, pixels, aspect} of labels)
      sprite.scale.set(perPixel * pixels * aspect, perPixel * pixels, 1);
    requestRender();
  }

  let touched = false;  // until someone turns it, the view fits itself to the window
  controls.addEventListener('start', () => { touched = true; });
  function resize() {
    const width = canvas.parentElement.clientWidth, height = canvas.parentElement.clientHeight;
    if (!width || !height) return;  // not shown now
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    if (!touched) views.perspective();
    scaleLabels();
  }

  if (map.group.children.length) addLayer('map', data.voxels.centers ? 'map' : 'scene', '#9aa3ae', map.group);
  addTrees();
  if (sweep) addAlternatives(); else paths.forEach(addPath);
  if (paths.length) {
    if (hasBeliefs) addEllipsoids();
    if (waypoints.length) {
      addFrusta();
      addWaypoints();
    }
  }
  if (paths.length || data.flight) {
    addMarker('start', data.start, cssColor('--start'));
    addMarker(isRecorded ? 'end' : 'goal', data.goal, cssColor('--goal'));
  }
  drawGround();
  new ResizeObserver(resize).observe(canvas.parentElement);
  resize();

  const largest = Math.max(0, ...paths.flatMap((path) => path.points.map(
      (point) => worstSigma(point.position_covariance))));
  return {
    layers, select, choose, setExaggeration, setCut, views, gridStep, mapBox: map.box, hidden: map.hidden,
    drawGround, addLayer, requestRender, thick, extent, controls,
    show: (name, visible) => { layers[name].object.visible = visible; requestRender(); },
    suggestedExaggeration: [1, 2, 5, 10, 20, 50, 100].find((k) => 3 * k * largest > 0.025 * extent) || 100,
  };
}
