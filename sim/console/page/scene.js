// The 3-D view, in the axes of the sensor (LRF): x right, y along the boresight, z up. It draws only when
// something changed.
import { Bodies, hasTruePlace, makeShape } from '/bodies.js';
import { FrameRate } from '/frame_rate.js';
import { Gizmo, makeTargetAxes, SensorLines, sizeLetters } from '/axes.js';
import { Orbit } from '/orbit.js';
import { PointCloud } from '/point_cloud.js';
import { SurfaceRanges } from '/surface_ranges.js';
import { themeColour } from '/colours.js';

const FREE_FOV_DEG = 35;
const DEFAULT_SENSOR_FOV = 0.35;  // rad, until a frame has told
const STILL_MS = 200;   // without a change for this long, the picture is drawn once more with fine pixels
const FINE_RATIO = 2;
const LARGE_POINT = 4;  // pixels
const SMALL_POINT = 2;  // while a slow machine moves the camera
const TARGET_VIEW = { azimuth: 0.6, elevation: 0.45 };
const SIDE_VIEW = { azimuth: 0.75, elevation: 0.4 };

export class SceneView {
  /** Throws if the browser has no WebGL. */
  constructor(viewport, canvas, gizmoCanvas) {
    this.viewport = viewport;
    this.renderer = makeRenderer(canvas);
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(FREE_FOV_DEG, 1, 0.1, 1000);
    this.cloud = new PointCloud();
    this.bodies = new Bodies(this.scene);
    this.axes = makeTargetAxes();
    this.sensor = new SensorLines();
    this.surface = new SurfaceRanges(this.renderer);
    this.cloud.uniforms.surface.value = this.surface.texture;
    this.gizmo = new Gizmo(gizmoCanvas);
    this.rate = new FrameRate();
    this.orbit = new Orbit(canvas, (isTurned) => this.orbited(isTurned));
    this.radius = 1;
    this.hasAxes = true;
    this.isSurfaceStale = true;
    this.hasStep = false;
    this.onViewChange = () => {};
    this.onStill = () => {};
    this.shape = null;
    this.hasMesh = false;
    this.clearColour = new THREE.Color();
    this.addFixedParts();
    this.draw = this.draw.bind(this);
    this.isPending = false;
    this.isMoving = false;  // the user moves the camera
    this.lastDrawMs = 0;
    this.stillTimer = 0;
    this.settle = this.settle.bind(this);
    this.drawStill = this.drawStill.bind(this);
    this.setView('reset');
    new ResizeObserver(() => this.resize()).observe(viewport);
  }

  addFixedParts() {
    this.scene.add(this.cloud.object, this.axes, this.sensor.object);
  }

  setRadius(radius) {
    this.radius = radius;
    this.axes.scale.setScalar(1.15 * radius);
    this.cloud.uniforms.towards_camera.value = 0.03 * radius;
    this.setView(this.view);
  }

  setMesh(mesh) {
    this.setShape(makeShape(mesh));
    this.hasMesh = true;
    this.setRadius(this.shape.radius);
  }

  /** Of another target than that of the run to come. */
  removeMesh() {
    if (this.hasMesh) this.setShape(makeShape({ vertices: new Float32Array(0), triangles: new Uint16Array(0) }));
    this.hasMesh = false;
    this.invalidate();
  }

  setShape(shape) {
    if (this.shape) for (const geometry of [this.shape.indexed, this.shape.faces, this.shape.edges]) geometry.dispose();
    this.shape = shape;
    this.bodies.setShape(shape);
    this.surface.setGeometry(shape.indexed);
    this.isSurfaceStale = true;
  }

  show(step) {
    this.cloud.show(step.frame);
    const isPlaced = hasTruePlace(step.detail) || Boolean(step.detail && step.detail.pose);
    if (this.cloud.count > 0 && !isPlaced) this.cloud.centre(this.orbit.centre);
    this.bodies.show(step.detail, this.orbit.centre);
    this.placeAxes();
    this.sensor.set(this.cloud.fov || DEFAULT_SENSOR_FOV, this.orbit.centre.length() + this.radius);
    this.isSurfaceStale = true;
    if (this.hasStep) this.followTarget();
    else this.setView(this.view);
    this.hasStep = true;
    this.invalidate();
  }

  placeAxes() {
    const body = this.bodies.best();
    this.axes.visible = this.hasAxes && body !== null;
    if (!body) return;
    this.axes.position.copy(body.group.position);
    this.axes.quaternion.copy(body.group.quaternion);
  }

  setLayer(name, isOn) {
    if (name === 'points') this.cloud.object.visible = isOn;
    else if (name === 'axes') this.hasAxes = isOn;
    else this.bodies[name].isOn = isOn;
    for (const body of this.bodies.all) body.refresh();
    this.placeAxes();
    this.invalidate();
  }

  setColouring(isByResidual) {
    this.cloud.uniforms.by_residual.value = isByResidual;
    this.isSurfaceStale = true;
    this.invalidate();
  }

  /** 'sensor', 'target' or 'reset'. */
  setView(view) {
    this.view = view;
    this.orbit.frame.set(0, 0, 0, 1);
    if (view === 'sensor') this.orbit.set(0, 0, this.orbit.centre.length());
    else if (view === 'target') this.orbit.set(TARGET_VIEW.azimuth, TARGET_VIEW.elevation, 4.6 * this.radius);
    else this.orbit.set(SIDE_VIEW.azimuth, SIDE_VIEW.elevation, 4.6 * this.radius);
    this.followTarget();
    this.onViewChange(view);
    this.invalidate();
  }

  // What the chosen view keeps in step with the target.
  followTarget() {
    const body = this.bodies.best();
    if (this.view === 'target' && body) this.orbit.frame.copy(body.group.quaternion);
    if (this.view === 'sensor') this.orbit.distance = this.orbit.centre.length();
    this.setFieldOfView();
  }

  setFieldOfView() {
    const sensor = 1.06 * THREE.Math.radToDeg(this.cloud.fov || DEFAULT_SENSOR_FOV);
    // The sensor's square fits into the shorter side.
    const narrow = this.camera.aspect < 1 ? 1 / this.camera.aspect : 1;
    this.camera.fov = this.view === 'sensor' ? Math.min(170, sensor * narrow) : FREE_FOV_DEG;
    this.camera.updateProjectionMatrix();
  }

  orbited(isTurned) {
    // Out of the sensor's place the view is a free one; the target's view keeps turning with the target.
    if (isTurned && this.view === 'sensor') {
      this.view = 'free';
      this.onViewChange('free');
    }
    this.isMoving = true;
    this.invalidate();
  }

  resize() {
    const { clientWidth, clientHeight } = this.viewport;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.setFieldOfView();
    this.invalidate();
  }

  setTheme() {
    this.clearColour.set(themeColour('scene'));
    this.invalidate();
  }

  invalidate() {
    if (this.isPending) return;
    this.isPending = true;
    requestAnimationFrame(this.draw);
  }

  draw(nowMs) {
    this.isPending = false;
    if (this.rate.isSlow) this.paint(1, SMALL_POINT);
    else this.paint(Math.min(2, window.devicePixelRatio), LARGE_POINT);
    if (this.isMoving) this.rate.count(nowMs);
    this.isMoving = false;
    this.lastDrawMs = nowMs;
    if (this.stillTimer === 0) this.stillTimer = setTimeout(this.settle, STILL_MS);
  }

  // Smoothing every frame would cost more than half of the frame rate without a graphics processor.
  settle() {
    const waitMs = this.lastDrawMs + STILL_MS - performance.now();
    this.stillTimer = waitMs > 0 ? setTimeout(this.settle, waitMs + 5) : 0;
    if (this.stillTimer === 0 && !this.isPending) requestAnimationFrame(this.drawStill);
  }

  drawStill() {
    if (this.isPending) return;
    this.paint(this.rate.isSlow ? 1 : FINE_RATIO, LARGE_POINT);
    this.onStill();
  }

  paint(pixelRatio, largestPoint) {
    if (this.renderer.getPixelRatio() !== pixelRatio) this.renderer.setPixelRatio(pixelRatio);
    this.placeCamera(largestPoint);
    this.drawSurface();
    this.renderer.setClearColor(this.clearColour, 1);
    this.renderer.render(this.scene, this.camera);
    this.gizmo.draw(this.camera);
  }

  placeCamera(largestPoint) {
    const far = this.orbit.distance + this.orbit.centre.length() + 4 * this.radius;
    this.camera.near = Math.max(0.02, 0.01 * this.orbit.distance);
    this.camera.far = far;
    this.camera.updateProjectionMatrix();
    this.orbit.place(this.camera);
    this.cloud.setScreen(this.renderer.domElement.height, this.renderer.getPixelRatio(), largestPoint, this.camera);
    sizeLetters(this.axes, this.camera, this.viewport.clientHeight);
  }

  drawSurface() {
    if (!this.isSurfaceStale || !this.cloud.uniforms.by_residual.value) return;
    const pose = this.bodies.pose;
    this.surface.draw(this.cloud.rays, this.cloud.fov, pose.isKnown ? pose.group : null, this.radius);
    this.isSurfaceStale = false;
  }
}

function makeRenderer(canvas) {
  const wishes = { antialias: false, alpha: false, powerPreference: 'high-performance' };
  const context = canvas.getContext('webgl2', wishes) || canvas.getContext('webgl', wishes);
  if (!context) throw new Error('This browser has no WebGL.');
  return new THREE.WebGLRenderer({ canvas, context });
}
