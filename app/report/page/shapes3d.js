// Shapes of the 3-D view: ellipsoids of covariances, view frusta, tubes, cubes of maps.
'use strict';

const point3 = (a) => new THREE.Vector3(a[0], a[1], a[2]);

/// Lower triangular L with L L^T = covariance; positive semi-definite is enough.
function cholesky(c) {
  const root = (x) => Math.sqrt(Math.max(x, 1e-14));
  const a = root(c[0]), b = c[3] / a, d = c[6] / a;
  const e = root(c[4] - b * b), f = (c[7] - d * b) / e, g = root(c[8] - d * d - f * f);
  return [a, 0, 0, b, e, 0, d, f, g];
}

const kTruthColor = '#aa4499';
const unitSphere = new THREE.SphereBufferGeometry(1, 28, 18);

/// Where a position with a covariance is, as a transformed sphere.
class Ellipsoid extends THREE.Mesh {
  constructor(material, position, covariance) {
    super(unitSphere, material);
    this.matrixAutoUpdate = false;
    this.shape = cholesky(covariance);
    this.at = position;
  }
  /// @param s standard deviations
  scaleTo(s) {
    const l = this.shape, at = this.at;
    this.matrix.set(s * l[0], 0, 0, at[0], s * l[3], s * l[4], 0, at[1],
                    s * l[6], s * l[7], s * l[8], at[2], 0, 0, 0, 1);
    this.matrixWorldNeedsUpdate = true;
  }
}

/// Corners of the image at a depth, from the upper left one clockwise, in the world.
/// @param rows of the camera's pose T_w_c, the upper three
function imageCorners(rows, depth) {
  const [right, down] = data.field_of_view.map((angle) => depth * Math.tan(angle / 2));
  return [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([u, v]) => {
    const c = [u * right, v * down, depth, 1];
    return new THREE.Vector3(...[0, 4, 8].map((r) => c.reduce((sum, x, k) => sum + rows[r + k] * x, 0)));
  });
}

function frustumLines(rows, depth) {
  const apex = new THREE.Vector3(rows[3], rows[7], rows[11]), corners = imageCorners(rows, depth);
  return corners.flatMap((corner, i) => [apex, corner, corner, corners[(i + 1) % 4]]);
}

/// The image plane of a camera with its image.
function imagePlane(rows, depth, texture) {
  const [a, b, c, d] = imageCorners(rows, depth);
  const geometry = new THREE.BufferGeometry().setFromPoints([a, b, c, a, c, d]);
  geometry.setAttribute('uv', new THREE.Float32BufferAttribute([0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1], 2));
  return new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({map: texture, side: THREE.DoubleSide}));
}

/// The robot at a pose of its camera: frustum, body, and the ellipsoid of its position.
/// @param view3d as createView3d() gives it
function robotShapes(rows, covariance, color, {extent, thick}) {
  const frustum = new THREE.LineSegments(
      new THREE.BufferGeometry().setFromPoints(frustumLines(rows, 0.05 * extent)),
      new THREE.LineBasicMaterial({color}));
  const position = [rows[3], rows[7], rows[11]];
  const body = new THREE.Mesh(new THREE.SphereBufferGeometry(2.6 * thick, 20, 14),
                              new THREE.MeshLambertMaterial({color}));
  body.position.copy(point3(position));
  const ellipsoid = new Ellipsoid(new THREE.MeshLambertMaterial(
      {color, transparent: true, opacity: 0.4, depthWrite: false}), position, covariance);
  return {all: [frustum, body, ellipsoid], ellipsoid};
}

function empty3d(group) {
  for (const child of [...group.children]) {
    group.remove(child);
    if (child.geometry !== unitSphere) child.geometry.dispose();
    child.material.dispose();
  }
}

class Polyline extends THREE.Curve {
  constructor(points) { super(); this.points = points; }
  getPoint(t) {
    const last = this.points.length - 1, i = Math.min(last - 1, Math.floor(t * last + 1e-9));
    return this.points[i].clone().lerp(this.points[i + 1], t * last - i);
  }
  getPointAt(t) { return this.getPoint(t); }  // samples fall on the points, whatever their spacing
}

/// @returns null where there is no way between two places
function tubeAlong(positions, radius, color) {
  const points = positions.map(point3).filter((point, k, all) => k === 0 || point.distanceTo(all[k - 1]) > 1e-9);
  if (points.length < 2) return null;
  return new THREE.Mesh(
      new THREE.TubeBufferGeometry(new Polyline(points), points.length - 1, radius, 8),
      new THREE.MeshLambertMaterial({color, emissive: color, emissiveIntensity: 0.12}));
}

/// Cubes as instances of the three faces that look at the camera. They can be added, painted
/// otherwise, and removed.
class Cubes {
  /// @param size edge [m]
  /// @param hidden uniforms: cut, the height above which nothing is drawn; low and high, bounds in x
  ///        and y beyond which nothing above low.z is drawn
  constructor(size, hidden) {
    this.count = 0;
    this.geometry = new THREE.InstancedBufferGeometry();
    const corners = [];
    for (let axis = 0; axis < 3; ++axis)
      for (const [u, v] of [[-1, -1], [1, -1], [1, 1], [-1, -1], [1, 1], [-1, 1]]) {
        const corner = [0, 0, 0];
        corner[axis] = 1; corner[(axis + 1) % 3] = u; corner[(axis + 2) % 3] = v;
        corners.push(...corner, axis);
      }
    const interleaved = new THREE.InterleavedBuffer(new Float32Array(corners), 4);
    this.geometry.setAttribute('position', new THREE.InterleavedBufferAttribute(interleaved, 3, 0));
    this.geometry.setAttribute('axis', new THREE.InterleavedBufferAttribute(interleaved, 1, 3));
    this.reserve(1024);
    this.mesh = new THREE.Mesh(this.geometry, new THREE.ShaderMaterial({
      side: THREE.DoubleSide, uniforms: {size: {value: size}, ...hidden},
      vertexShader: `
        attribute vec3 center; attribute float grey, axis;
        uniform float size, cut; uniform vec3 low, high; varying float shade;
        void main() {
          vec3 side = mix(vec3(-1.), vec3(1.), step(center, cameraPosition));
          shade = grey * (axis > 1.5 ? 1. : axis > .5 ? .92 : .84);
          gl_Position = projectionMatrix * viewMatrix * vec4(center + .5 * size * position * side, 1.);
          bool isWall = center.z > low.z && (any(lessThan(center.xy, low.xy)) || any(greaterThan(center.xy, high.xy)));
          if (center.z > cut || isWall) gl_Position = vec4(0., 0., 2., 1.);
        }`,
      fragmentShader: 'varying float shade; void main() { gl_FragColor = vec4(vec3(shade), 1.); }'}));
    this.mesh.frustumCulled = false;
  }

  reserve(capacity) {
    const centers = new Float32Array(3 * capacity), greys = new Uint8Array(capacity);
    if (this.centers) {
      centers.set(this.centers);
      greys.set(this.greys);
    }
    [this.centers, this.greys, this.capacity] = [centers, greys, capacity];
    this.geometry.setAttribute('center', new THREE.InstancedBufferAttribute(centers, 3));
    this.geometry.setAttribute('grey', new THREE.InstancedBufferAttribute(greys, 1, true));
  }

  /// @returns the number of the cube
  add(x, y, z, grey) {
    if (this.count === this.capacity) this.reserve(2 * this.capacity);
    this.centers.set([x, y, z], 3 * this.count);
    this.greys[this.count] = grey;
    return this.count++;
  }

  /// The last cube takes the number of the one that goes.
  remove(number) {
    --this.count;
    this.centers.copyWithin(3 * number, 3 * this.count, 3 * this.count + 3);
    this.greys[number] = this.greys[this.count];
  }

  /// Draws them as they are now.
  commit() {
    this.geometry.maxInstancedCount = this.count;
    this.mesh.visible = this.count > 0;
    for (const name of ['center', 'grey']) this.geometry.getAttribute(name).needsUpdate = true;
  }
}
