// The dense map: squares of the size of its cells.
import {BufferAttribute, BufferGeometry, Color, Points, PointsMaterial} from 'three';

import {surfaceColor} from './surface_colors.js';

const SMALLEST = 1e-3;   // metres
const ODD_SHADE = 0.86;  // of every other cell, as on a chessboard

/** The size of the cells: the smallest distance between two different values. */
function smallestGap(values) {
  values.sort((a, b) => a - b);
  let least = Infinity;
  for (let i = 1; i < values.length; ++i) {
    const gap = values[i] - values[i - 1];
    if (gap > SMALLEST && gap < least) least = gap;
  }
  return Number.isFinite(least) ? least : 0.05;
}

export class VoxelLayer {
  /** `fov`: of the view, in degrees. */
  constructor(fov) {
    this.sizeOfMetre = 1 / Math.tan(fov * Math.PI / 360);  // three.js takes sizes as if it were 90 degrees
    this.points = new Points(new BufferGeometry(), new PointsMaterial({vertexColors: true}));
    this.points.frustumCulled = false;
  }

  paint(run, mode) {
    const voxels = [...run.voxels.values()];
    const cell = smallestGap(voxels.map(({position}) => position[0]));
    const positions = new Float32Array(3 * voxels.length), colors = new Float32Array(3 * voxels.length);
    const color = new Color();
    voxels.forEach(({position, rgb, label, occupancy}, i) => {
      positions.set(position, 3 * i);
      surfaceColor(mode, {rgb, label, height: -position[1], occupancy}, run.hello.classes, color);
      if (position.reduce((sum, x) => sum + Math.floor(x / cell), 0) & 1) color.multiplyScalar(ODD_SHADE);
      colors.set([color.r, color.g, color.b], 3 * i);
    });
    this.points.geometry.dispose();
    this.points.geometry = new BufferGeometry();
    this.points.geometry.setAttribute('position', new BufferAttribute(positions, 3));
    this.points.geometry.setAttribute('color', new BufferAttribute(colors, 3));
    this.points.material.size = this.sizeOfMetre * cell;
  }
}
