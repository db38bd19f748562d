// The map of the 3-D view: textured triangles or grey cubes.
'use strict';

/// @param textureFrom gives a texture for the URI of a picture
/// @returns group to be shown, box around it, hidden (uniforms of Cubes), setCut(height) that hides
///          what is higher, hideNearWalls(eye) that hides the outer walls between it and the inside
function createMap3d(textureFrom) {
  const cutPlane = new THREE.Plane(new THREE.Vector3(0, 0, -1), 1e9);
  const hidden = {cut: {value: 1e9}, low: {value: new THREE.Vector3()}, high: {value: new THREE.Vector3()}};
  const box = new THREE.Box3();
  const group = new THREE.Group();
  const walls = [];  // meshes of an outer wall: {mesh, axis, sign of the side}

  function addMesh() {
    const positions = floatsOf(data.mesh.positions), uv = floatsOf(data.mesh.uv);
    const textures = indicesOf(data.mesh.textures);
    box.union(new THREE.Box3().setFromArray(positions));
    const parts = new Map();  // by texture and side
    textures.forEach((texture, i) => {
      const corners = positions.subarray(9 * i, 9 * i + 9), side = outerSide(corners);
      const key = `${texture} ${side}`;
      if (!parts.has(key)) parts.set(key, {texture, side, positions: [], uv: []});
      parts.get(key).positions.push(...corners);
      parts.get(key).uv.push(...uv.subarray(6 * i, 6 * i + 6));
    });
    const materials = data.mesh.images.map((image) => new THREE.MeshBasicMaterial({
      map: textureFrom(image), side: THREE.DoubleSide, clippingPlanes: [cutPlane],
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1}));
    for (const part of parts.values()) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.Float32BufferAttribute(part.positions, 3));
      geometry.setAttribute('uv', new THREE.Float32BufferAttribute(part.uv, 2));
      const mesh = new THREE.Mesh(geometry, materials[part.texture]);
      if (part.side) walls.push({mesh, axis: part.side.slice(1), sign: part.side[0] === '-' ? -1 : 1});
      group.add(mesh);
    }
  }

  /// How thick the outer walls are at most, and what hangs on them [m].
  const wallSize = () => 0.02 * box.getSize(new THREE.Vector3()).length();

  /// The side of the box that a triangle lies in: '-x', '+x', '-y' or '+y'; '' for others.
  function outerSide(corners) {
    const near = wallSize();
    for (const [axis, name] of [[0, 'x'], [1, 'y']]) {
      const values = [corners[axis], corners[3 + axis], corners[6 + axis]];
      if (values.every((value) => value < box.min[name] + near)) return `-${name}`;
      if (values.every((value) => value > box.max[name] - near)) return `+${name}`;
    }
    return '';
  }

  const isOutside = (eye, axis, sign) => sign < 0 ? eye[axis] < box.min[axis] : eye[axis] > box.max[axis];
  function hideNearWalls(eye) {
    for (const {mesh, axis, sign} of walls) mesh.visible = !isOutside(eye, axis, sign);
    const size = wallSize();
    for (const axis of ['x', 'y']) {
      hidden.low.value[axis] = isOutside(eye, axis, -1) ? box.min[axis] + size : -1e9;
      hidden.high.value[axis] = isOutside(eye, axis, 1) ? box.max[axis] - size : 1e9;
    }
    hidden.low.value.z = box.min.z + size / 2;  // the floor stays
  }

  function addVoxels() {
    const centers = floatsOf(data.voxels.centers), greys = bytesOf(data.voxels.grey);
    const cubes = new Cubes(data.voxels.size, hidden);
    cubes.reserve(greys.length);
    greys.forEach((grey, i) => cubes.add(centers[3 * i], centers[3 * i + 1], centers[3 * i + 2], grey));
    cubes.commit();
    group.add(cubes.mesh);
    box.union(new THREE.Box3().setFromArray(centers));
  }

  if (data.mesh.positions) addMesh();
  if (data.voxels.centers) addVoxels();
  if (data.flight) {
    const [least, largest] = data.flight.header.scene;
    box.union(new THREE.Box3(point3(least), point3(largest)));
  }
  return {
    group, box, hidden, hideNearWalls,
    setCut(height) { cutPlane.constant = hidden.cut.value = height; },
  };
}
