// The newest image with what the pipeline made of it, and why features were dropped.

// Safe for colour blindness (Okabe and Ito, 2008); those of the output `images`.
const COLORS = {inlier: '#009e73', outlier: '#f0e442', moving: '#d55e00', unmatched: '#aaaaaa'};
const WORDS = {
  inlier: 'fit the pose', outlier: 'do not fit the pose', moving: 'not used, as moving', unmatched: 'without a landmark'};
const [LABELLED, OBJECT_MOVES, FREE_SPACE, MOVING_POINT, WEIGHT_ZERO] = [1, 2, 4, 8, 16];
const NEAR = 8;  // px of the image

function reasonOf(feature, classes) {
  const name = classes[feature.label]?.name ?? `class ${feature.label}`;
  if (feature.reasons & OBJECT_MOVES) return `${name}, moving`;
  if (feature.reasons & LABELLED) return name;
  if (feature.reasons & FREE_SPACE) return 'free space before';
  if (feature.reasons & MOVING_POINT) return 'beside moving points';
  if (feature.reasons & WEIGHT_ZERO) return 'excluded by the decision';
  return 'little weight';
}

function tinted(mask) {
  const canvas = new OffscreenCanvas(mask.columns, mask.rows);
  const context = canvas.getContext('2d');
  const image = context.createImageData(mask.columns, mask.rows);
  let at = 0;
  for (const {label, unused, length} of mask.runs) {
    const color = unused ? [255, 60, 40, 105] : label > 0 ? [60, 160, 235, 105] : null;
    if (color) for (let i = at; i < at + length; ++i) image.data.set(color, 4 * i);
    at += length;
  }
  context.putImageData(image, 0, 0);
  return canvas;
}

export class ImagePanel {
  constructor() {
    this.canvas = document.getElementById('image');
    this.context = this.canvas.getContext('2d');
    this.tip = document.getElementById('tip');
    this.choices = Object.fromEntries(['features', 'moving', 'mask'].map((name) => {
      const box = document.getElementById(`show-${name}`);
      box.addEventListener('change', () => this.draw());
      return [name, box];
    }));
    this.canvas.addEventListener('mousemove', (event) => this.explain(event));
    this.canvas.addEventListener('mouseleave', () => { this.tip.hidden = true; });
  }

  async show(run) {
    const picture = run.picture;
    if (!picture || picture === this.wanted) return;
    this.wanted = picture;
    this.count(picture, run.hello.classes);
    document.getElementById('frame-number').textContent = `frame ${picture.frame}`;
    const bitmap = await createImageBitmap(new Blob([picture.jpeg], {type: 'image/jpeg'}));
    if (picture !== this.wanted) return bitmap.close();  // a later one has come meanwhile
    this.bitmap?.close();
    [this.picture, this.bitmap, this.classes] = [picture, bitmap, run.hello.classes];
    this.mask = picture.mask && tinted(picture.mask);
    this.draw();
  }

  draw() {
    if (!this.bitmap) return;
    const {canvas, context, bitmap, picture} = this;
    const scale = Math.max(1, Math.min(3, Math.round(canvas.clientWidth * devicePixelRatio / bitmap.width)));
    canvas.width = bitmap.width * scale;
    canvas.height = bitmap.height * scale;
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.drawImage(bitmap, 0, 0);
    if (this.choices.mask.checked && this.mask) context.drawImage(this.mask, 0, 0, bitmap.width, bitmap.height);
    context.translate(0.5, 0.5);  // pixel (0, 0) is the centre of the first one
    if (this.choices.features.checked) picture.features.forEach((feature) => this.drawFeature(feature));
    if (this.choices.moving.checked) this.drawMoving(picture.moving);
  }

  drawFeature({x, y, use}) {
    const context = this.context;
    context.strokeStyle = context.fillStyle = COLORS[use];
    context.lineWidth = 1.2;
    context.beginPath();
    if (use === 'unmatched') {
      context.arc(x, y, 1, 0, 7);
      context.fill();
    } else if (use === 'inlier') {
      context.arc(x, y, 2.5, 0, 7);
      context.stroke();
    } else {
      context.moveTo(x - 3, y - 3);
      context.lineTo(x + 3, y + 3);
      context.moveTo(x + 3, y - 3);
      context.lineTo(x - 3, y + 3);
      context.stroke();
    }
  }

  drawMoving(points) {
    const context = this.context;
    context.strokeStyle = context.fillStyle = '#ff9d2e';
    for (const {x0, y0, x, y} of points) {
      context.beginPath();
      context.moveTo(x0, y0);
      context.lineTo(x, y);
      context.stroke();
      context.beginPath();
      context.arc(x, y, 2, 0, 7);
      context.fill();
    }
  }

  count(picture, classes) {
    const counts = {inlier: 0, outlier: 0, moving: 0, unmatched: 0};
    const reasons = new Map();
    for (const feature of picture.features) {
      ++counts[feature.use];
      if (feature.use !== 'moving') continue;
      const reason = reasonOf(feature, classes);
      reasons.set(reason, (reasons.get(reason) ?? 0) + 1);
    }
    const why = [...reasons].sort((a, b) => b[1] - a[1]).map(([reason, count]) => `${reason}: ${count}`).join('; ');
    document.getElementById('legend').replaceChildren(...Object.entries(counts).map(([use, count]) => {
      const item = document.createElement('li');
      const mark = document.createElement('i');
      mark.style.background = COLORS[use];
      item.append(mark, `${count} ${WORDS[use]}`);
      if (use === 'moving' && why) {
        const small = document.createElement('small');
        small.textContent = ` (${why})`;
        item.append(small);
      }
      return item;
    }));
  }

  explain(event) {
    if (!this.bitmap) return;
    const area = this.canvas.getBoundingClientRect();
    const scale = Math.min(area.width / this.bitmap.width, area.height / this.bitmap.height);
    const x = (event.clientX - area.left - (area.width - scale * this.bitmap.width) / 2) / scale;
    const y = (event.clientY - area.top - (area.height - scale * this.bitmap.height) / 2) / scale;
    let best = null, least = NEAR;
    for (const feature of this.picture.features) {
      const distance = Math.hypot(feature.x - x, feature.y - y);
      if (distance < least) [best, least] = [feature, distance];
    }
    this.tip.hidden = !best;
    if (!best) return;
    const words = {inlier: 'fits the pose', outlier: 'does not fit the pose', unmatched: 'no landmark of the map',
      moving: `not used: ${reasonOf(best, this.classes)}`};
    this.tip.textContent = words[best.use];
    this.tip.style.left = `${Math.min(event.clientX - area.left + 12, area.width - 160)}px`;
    this.tip.style.top = `${event.clientY - area.top + 12}px`;
  }
}
