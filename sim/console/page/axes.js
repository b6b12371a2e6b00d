// Lines that orient: the target's axes, the sensor's field of view, and the small cross of the sensor's axes.
const AXIS_COLOURS = ['#ff6a5e', '#63d17c', '#6ea8ff'];
const LABEL_PIXELS = 32;

function letter(text, colour) {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = LABEL_PIXELS;
  const pen = canvas.getContext('2d');
  pen.font = 'bold 26px sans-serif';
  pen.textAlign = 'center';
  pen.textBaseline = 'middle';
  pen.fillStyle = colour;
  pen.fillText(text, LABEL_PIXELS / 2, LABEL_PIXELS / 2);
  const map = new THREE.CanvasTexture(canvas);
  return new THREE.Sprite(new THREE.SpriteMaterial({ map, sizeAttenuation: false, depthTest: false }));
}

/** The axes of the TRF, one metre long: scale the group. */
export function makeTargetAxes() {
  const group = new THREE.Group();
  ['x', 'y', 'z'].forEach((name, index) => {
    const end = new THREE.Vector3().setComponent(index, 1);
    const line = new THREE.BufferGeometry().setFromPoints([new THREE.Vector3(), end]);
    group.add(new THREE.Line(line, new THREE.LineBasicMaterial({ color: AXIS_COLOURS[index] })));
    const label = letter(name, AXIS_COLOURS[index]);
    label.position.copy(end).multiplyScalar(1.08);
    group.add(label);
  });
  group.visible = false;
  return group;
}

/** Letters keep their size on the screen, whatever the group's scale and the camera's field of view. */
export function sizeLetters(group, camera, pixelsHigh) {
  const size = (2 * Math.tan(0.5 * THREE.Math.degToRad(camera.fov)) * 16) / Math.max(1, pixelsHigh);
  for (const child of group.children)
    if (child.isSprite) child.scale.setScalar(size / Math.max(1e-6, group.scale.x));
}

/** The sensor's place, its axes there and the edges of its field of view. */
export class SensorLines {
  constructor() {
    const place = new THREE.BufferAttribute(new Float32Array(3 * 16), 3);
    const geometry = new THREE.BufferGeometry().setAttribute('position', place);
    this.place = place;
    this.object = new THREE.Group();
    const edges = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: '#56606d' }));
    edges.frustumCulled = false;
    this.cross = makeTargetAxes();
    this.cross.visible = true;
    this.cross.remove(...this.cross.children.filter((child) => child.isSprite));
    this.object.add(edges, this.cross);
    this.key = '';
  }

  set(fov, range) {
    const key = `${fov} ${range.toFixed(1)}`;
    if (key === this.key) return;
    this.key = key;
    const reach = range * Math.tan(0.5 * fov);
    const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]];
    corners.forEach(([x, z], i) => {
      const [nextX, nextZ] = corners[(i + 1) % 4];
      this.place.setXYZ(4 * i, 0, 0, 0);
      this.place.setXYZ(4 * i + 1, x * reach, range, z * reach);
      this.place.setXYZ(4 * i + 2, x * reach, range, z * reach);
      this.place.setXYZ(4 * i + 3, nextX * reach, range, nextZ * reach);
    });
    this.place.needsUpdate = true;
    this.cross.scale.setScalar(0.05 * range);
  }
}

const GIZMO_NAMES = ['right', 'boresight', 'up'];

/** Draws the sensor's axes as the camera sees them. */
export class Gizmo {
  constructor(canvas) {
    this.pen = canvas.getContext('2d');
    this.size = canvas.width;
    this.order = [0, 1, 2];
  }

  draw(camera) {
    const pen = this.pen;
    const elements = camera.matrixWorldInverse.elements;
    pen.clearRect(0, 0, this.size, this.size);
    pen.font = '10px sans-serif';
    pen.textBaseline = 'middle';
    pen.textAlign = 'center';
    this.order.sort((a, b) => elements[4 * a + 2] - elements[4 * b + 2]);  // the nearest last
    for (const axis of this.order) this.drawAxis(axis, elements[4 * axis], -elements[4 * axis + 1]);
  }

  drawAxis(axis, x, y) {
    const pen = this.pen;
    const middle = this.size / 2;
    pen.strokeStyle = pen.fillStyle = AXIS_COLOURS[axis];
    pen.lineWidth = 2;
    pen.beginPath();
    pen.moveTo(middle, middle);
    pen.lineTo(middle + 22 * x, middle + 22 * y);
    pen.stroke();
    if (x * x + y * y < 0.06) return;  // it points at the viewer: its name would cover the others
    const halfText = pen.measureText(GIZMO_NAMES[axis]).width / 2;
    const textX = Math.max(halfText, Math.min(this.size - halfText, middle + 30 * x));
    pen.fillText(GIZMO_NAMES[axis], textX, middle + 31 * y);
  }
}
