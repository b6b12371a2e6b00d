// The camera's orbit about a point: drag turns, right drag or shift and drag moves, the wheel zooms.
const TURN_PER_PIXEL = 0.008;  // rad
const ZOOM_PER_PIXEL = 0.0012;
const STEEPEST = 1.55;  // rad, short of the pole where the camera would roll

export class Orbit {
  /** `onChange(isTurned)`: the camera has to be placed anew; isTurned: the user did it. */
  constructor(element, onChange) {
    this.element = element;
    this.onChange = onChange;
    this.azimuth = 0;    // rad, 0: from the sensor's side
    this.elevation = 0;  // rad
    this.distance = 10;  // m
    this.centre = new THREE.Vector3();
    this.moved = new THREE.Vector3();        // of the centre, by the user
    this.frame = new THREE.Quaternion();     // of the axes in which the camera stands still
    this.direction = new THREE.Vector3();
    this.right = new THREE.Vector3();
    this.up = new THREE.Vector3();
    this.camera = null;
    this.listen();
  }

  set(azimuth, elevation, distance) {
    this.azimuth = azimuth;
    this.elevation = elevation;
    this.distance = distance;
    this.moved.set(0, 0, 0);
  }

  place(camera) {
    this.camera = camera;
    const flat = Math.cos(this.elevation);
    this.direction.set(flat * Math.sin(this.azimuth), -flat * Math.cos(this.azimuth), Math.sin(this.elevation));
    this.direction.applyQuaternion(this.frame);
    this.up.copy(this.centre).add(this.moved);
    camera.position.copy(this.up).addScaledVector(this.direction, this.distance);
    camera.up.set(0, 0, 1).applyQuaternion(this.frame);
    camera.lookAt(this.up);
    camera.updateMatrixWorld();
  }

  listen() {
    const element = this.element;
    element.addEventListener('contextmenu', (event) => event.preventDefault());
    element.addEventListener('pointerdown', (event) => element.setPointerCapture(event.pointerId));
    element.addEventListener('pointermove', (event) => {
      if (element.hasPointerCapture(event.pointerId)) this.drag(event);
    });
    element.addEventListener('wheel', (event) => this.zoom(event), { passive: false });
  }

  drag(event) {
    if ((event.buttons & 2) !== 0 || event.shiftKey) this.pan(event.movementX, event.movementY);
    else this.turn(event.movementX, event.movementY);
    this.onChange(true);
  }

  turn(x, y) {
    this.azimuth -= x * TURN_PER_PIXEL;
    this.elevation = Math.max(-STEEPEST, Math.min(STEEPEST, this.elevation + y * TURN_PER_PIXEL));
  }

  pan(x, y) {
    if (!this.camera) return;
    const halfHeight = this.distance * Math.tan(0.5 * THREE.Math.degToRad(this.camera.fov));
    const perPixel = (2 * halfHeight) / this.element.clientHeight;
    this.right.setFromMatrixColumn(this.camera.matrixWorld, 0);
    this.up.setFromMatrixColumn(this.camera.matrixWorld, 1);
    this.moved.addScaledVector(this.right, -x * perPixel).addScaledVector(this.up, y * perPixel);
  }

  zoom(event) {
    event.preventDefault();
    const pixels = event.deltaY * (event.deltaMode === 1 ? 16 : 1);
    this.distance = Math.max(0.05, Math.min(1e5, this.distance * Math.exp(pixels * ZOOM_PER_PIXEL)));
    this.onChange(true);
  }
}
