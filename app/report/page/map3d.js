// The map of the 3-D view: textured triangles or grey cubes.
'use strict';

/// @param textureFrom gives a texture for the URI of a picture
/// @returns group to be shown, box around it, setCut(height) that hides what is higher
function createMap3d(textureFrom) {
  const cutPlane = new THREE.Plane(new THREE.Vector3(0, 0, -1), 1e9);
  const voxelUniforms = {size: {value: data.voxels.size}, cut: {value: 1e9}};
  const box = new THREE.Box3();
  const group = new THREE.Group();

  function addMesh() {
    const positions = floatsOf(data.mesh.positions), uv = floatsOf(data.mesh.uv);
    const textures = indicesOf(data.mesh.textures);
    const parts = data.mesh.images.map(() => ({positions: [], uv: []}));
    textures.forEach((texture, i) => {
      for (let k = 9 * i; k < 9 * i + 9; ++k) parts[texture].positions.push(positions[k]);
      for (let k = 6 * i; k < 6 * i + 6; ++k) parts[texture].uv.push(uv[k]);
    });
    parts.forEach((part, i) => {
      if (!part.positions.length) return;
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.Float32BufferAttribute(part.positions, 3));
      geometry.setAttribute('uv', new THREE.Float32BufferAttribute(part.uv, 2));
      group.add(new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({
        map: textureFrom(data.mesh.images[i]), side: THREE.DoubleSide, clippingPlanes: [cutPlane],
        polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1})));
    });
    box.union(new THREE.Box3().setFromArray(positions));
  }

  /// Cubes as instances of the three faces that look at the camera.
  function addVoxels() {
    const centers = floatsOf(data.voxels.centers);
    const geometry = new THREE.InstancedBufferGeometry();
    const corners = [];
    for (let axis = 0; axis < 3; ++axis)
      for (const [u, v] of [[-1, -1], [1, -1], [1, 1], [-1, -1], [1, 1], [-1, 1]]) {
        const corner = [0, 0, 0];
        corner[axis] = 1; corner[(axis + 1) % 3] = u; corner[(axis + 2) % 3] = v;
        corners.push(...corner, axis);
      }
    const interleaved = new THREE.InterleavedBuffer(new Float32Array(corners), 4);
    geometry.setAttribute('position', new THREE.InterleavedBufferAttribute(interleaved, 3, 0));
    geometry.setAttribute('axis', new THREE.InterleavedBufferAttribute(interleaved, 1, 3));
    geometry.setAttribute('center', new THREE.InstancedBufferAttribute(centers, 3));
    geometry.setAttribute('grey', new THREE.InstancedBufferAttribute(bytesOf(data.voxels.grey), 1, true));
    const mesh = new THREE.Mesh(geometry, new THREE.ShaderMaterial({
      side: THREE.DoubleSide, uniforms: voxelUniforms,
      vertexShader: `
        attribute vec3 center; attribute float grey, axis;
        uniform float size, cut; varying float shade;
        void main() {
          vec3 side = mix(vec3(-1.), vec3(1.), step(center, cameraPosition));
          shade = grey * (axis > 1.5 ? 1. : axis > .5 ? .92 : .84);
          gl_Position = projectionMatrix * viewMatrix * vec4(center + .5 * size * position * side, 1.);
          if (center.z > cut) gl_Position = vec4(0., 0., 2., 1.);
        }`,
      fragmentShader: 'varying float shade; void main() { gl_FragColor = vec4(vec3(shade), 1.); }'}));
    mesh.frustumCulled = false;
    group.add(mesh);
    box.union(new THREE.Box3().setFromArray(centers));
  }

  if (data.mesh.positions) addMesh();
  if (data.voxels.centers) addVoxels();
  return {
    group, box,
    setCut(height) { cutPlane.constant = voxelUniforms.cut.value = height; },
  };
}
