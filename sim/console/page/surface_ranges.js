// The ranges that the sensor would measure to the target's surface at a pose, drawn by the GPU into an image
// with one pixel a ray. The range goes into the bytes red, green and blue in 1/1024 m, because not every
// browser can draw into floating-point images; alpha says where there is a surface.
const vertexText = `
  varying vec3 seen;
  void main() {
    vec4 place = modelViewMatrix * vec4(position, 1.0);
    seen = place.xyz;
    gl_Position = projectionMatrix * place;
  }`;
const fragmentText = `
  varying vec3 seen;
  void main() {
    float units = floor(length(seen) * 1024.0 + 0.5);
    float high = floor(units / 65536.0);
    float middle = floor((units - 65536.0 * high) / 256.0);
    gl_FragColor = vec4(high, middle, units - 65536.0 * high - 256.0 * middle, 255.0) / 255.0;
  }`;

export class SurfaceRanges {
  constructor(renderer) {
    this.renderer = renderer;
    this.target = new THREE.WebGLRenderTarget(4, 4,
      { minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter, generateMipmaps: false, stencilBuffer: false });
    const material = new THREE.ShaderMaterial({ vertexShader: vertexText, fragmentShader: fragmentText,
      side: THREE.DoubleSide, blending: THREE.NoBlending });
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.mesh.frustumCulled = false;
    this.scene = new THREE.Scene();
    this.scene.add(this.mesh);
    this.camera = new THREE.PerspectiveCamera(20, 1, 0.1, 1000);
    this.camera.up.set(0, 0, 1);
    this.camera.lookAt(0, 1, 0);
    this.hasGeometry = false;
  }

  get texture() {
    return this.target.texture;
  }

  setGeometry(geometry) {
    this.mesh.geometry = geometry;
    this.hasGeometry = true;
  }

  /** `body`: a group at the pose, or null if there is no pose. */
  draw(rays, fov, body, radiusM) {
    if (rays === 0) return;
    if (this.target.width !== rays) this.target.setSize(rays, rays);
    this.mesh.visible = body !== null && this.hasGeometry;
    if (this.mesh.visible) this.place(fov, body, radiusM);
    this.renderer.setRenderTarget(this.target);
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.clear();
    this.renderer.render(this.scene, this.camera);
    this.renderer.setRenderTarget(null);
  }

  place(fov, body, radiusM) {
    this.mesh.position.copy(body.position);
    this.mesh.quaternion.copy(body.quaternion);
    const range = body.position.length();
    this.camera.fov = THREE.Math.radToDeg(fov);
    this.camera.near = Math.max(0.05, range - 1.5 * radiusM);
    this.camera.far = range + 1.5 * radiusM;
    this.camera.updateProjectionMatrix();
  }
}
