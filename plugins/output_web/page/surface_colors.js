// Colours of surfaces: clouds of key frames, and voxels.

const UNKNOWN = [120, 130, 136], NO_NAME = [255, 0, 255];

/** Sets `color`, of a point with this colour and class, `height` metres above the first camera; `occupancy`, 0 to 1,
 * of voxels only: others have their colour then. */
export function surfaceColor(mode, {rgb, label, height, occupancy}, classes, color) {
  if (mode === 'occupancy' && occupancy !== undefined)  // blue at 50 %, red at 100 %
    return color.setHSL(0.6 * Math.min(1, 2 - 2 * occupancy), 0.75, 0.5);
  if (mode === 'height')  // violet to yellow and green, from 1.5 m below to 1.5 m above
    return color.setHSL(0.75 - 0.6 * Math.min(1, Math.max(0, (height + 1.5) / 3)), 0.65, 0.5);
  const [r, g, b] = mode === 'color' || mode === 'occupancy' ? rgb : label > 0 ? classes[label]?.color ?? NO_NAME : UNKNOWN;
  return color.setRGB(r / 255, g / 255, b / 255, 'srgb');
}
