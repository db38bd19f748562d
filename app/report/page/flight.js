// The log of a flight: unpacked moment by moment, and its state at any time.
'use strict';

const shortsOf = (base64) => new Int16Array(bytesOf(base64).buffer);

/// As FlightLog of the executable, which docstrings explain there.
class Flight {
  constructor({header, moments = [], end = null, live = false}) {
    Object.assign(this, {header, live, moments: [], flown: [], end: null});
    for (const moment of moments) this.add(moment);
    if (end) this.finish(end);
  }

  add(packed) {
    const moment = {
      ...packed,
      time: packed.update.time,
      cells: shortsOf(packed.cells),
      greys: bytesOf(packed.greys),
      plan: this.planFrom(floatsOf(packed.plan)),
    };
    if (packed.tree) moment.tree = this.treeFrom(new Uint16Array(bytesOf(packed.tree).buffer));
    this.addFlown(packed.flown);
    this.moments.push(moment);
  }

  finish(end) {
    this.addFlown(end.flown);
    this.end = end;
    this.live = false;
  }

  addFlown(base64) {
    const v = floatsOf(base64);
    for (let i = 0; i < v.length; i += 10)
      this.flown.push({time: v[i], way: v[i + 1], believed: [v[i + 2], v[i + 3], v[i + 4]],
                       truth: [v[i + 5], v[i + 6], v[i + 7]], trace: v[i + 8], yaw: v[i + 9]});
  }

  planFrom(v) {
    const points = [];
    for (let i = 0; i < v.length; i += 11) {
      const [xx, xy, xz, yy, yz, zz] = v.subarray(i + 3, i + 9);
      points.push({position: [v[i], v[i + 1], v[i + 2]],
                   covariance: [xx, xy, xz, xy, yy, yz, xz, yz, zz], trace: v[i + 9]});
    }
    return points;
  }

  /// Ends are in 65535ths of the box.
  treeFrom(v) {
    const [least, largest] = this.header.box;
    return Float32Array.from(v, (share, i) =>
        least[i % 3] + share / 65535 * (largest[i % 3] - least[i % 3]));
  }

  get duration() {
    const lastMoment = this.moments[this.moments.length - 1], lastPoint = this.flown[this.flown.length - 1];
    return Math.max(lastMoment ? lastMoment.time : 0, lastPoint ? lastPoint.time : 0);
  }

  /// The moment at a time; -1 before the first one.
  momentAt(time) {
    let low = -1;
    for (let high = this.moments.length; high - low > 1;) {
      const middle = (low + high) >> 1;
      if (this.moments[middle].time <= time + 1e-6) low = middle; else high = middle;
    }
    return low;
  }

  /// What a moment has of a part that not every moment has: its own, or the last one before.
  latest(part, index) {
    while (index > 0 && !this.moments[index][part]) --index;
    return this.moments[index][part];
  }

  /// The robot's pose between moments: that of the last moment, moved and turned since.
  robotAt(time, index) {
    const {time: since, robot} = this.moments[index];
    const flown = this.flownUntil(time), here = flown[flown.length - 1];
    const then = flown.filter((point) => point.time <= since + 1e-6).pop();
    const rows = [...robot.T_w_c_rows];
    if (here && then && here.time > since) {
      const turned = here.yaw - then.yaw, c = Math.cos(turned), s = Math.sin(turned);
      for (let i = 0; i < 3; ++i)
        [rows[i], rows[4 + i]] = [c * rows[i] - s * rows[4 + i], s * rows[i] + c * rows[4 + i]];
      here.believed.forEach((x, i) => { rows[4 * i + 3] = x; });
    }
    return {rows, covariance: robot.position_covariance};
  }

  flownUntil(time) { return this.flown.filter((point) => point.time <= time + 1e-6); }
}

const flight = data.flight ? new Flight(data.flight) : null;
