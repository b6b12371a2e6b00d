// The returns of a frame as points, coloured in the shader by their range or by how far they lie from the
// surface of the target at the pose.
import { scaleTable, sceneColours } from '/colours.js';

const RANGE_UNIT_M = 1 / 128;
const FIRST_CAPACITY = 16384;

/** From this distance to the surface of the pose on, the colour changes no more. */
export const RESIDUAL_LIMIT_M = 1;

const vertexText = `
  uniform float size_factor;       // pixels a metre at a distance of one metre
  uniform float pixel_ratio;
  uniform float largest;           // pixels
  uniform float towards_camera;    // m, so that a surface through the points does not hide half of them
  uniform float half_slope;        // tangent of half the field of view
  uniform float residual_limit;
  uniform vec2 range_limits;       // m, where the scale begins and ends
  uniform bool by_residual;
  uniform sampler2D surface;       // range of the pose's surface, see surface_ranges.js
  uniform sampler2D scale;
  uniform vec3 nearer, farther, agrees, no_surface;
  varying vec3 colour;

  vec3 residual_colour(float range) {
    vec2 place = 0.5 + 0.5 * vec2(position.x, position.z) / (position.y * half_slope);
    vec4 bytes = floor(255.0 * texture2D(surface, place) + 0.5);
    if (bytes.a < 128.0) return no_surface;
    float residual = range - dot(bytes.rgb, vec3(65536.0, 256.0, 1.0)) / 1024.0;
    return mix(agrees, residual < 0.0 ? nearer : farther, min(1.0, abs(residual) / residual_limit));
  }
  vec3 range_colour(float range) {
    float part = clamp((range - range_limits.x) / (range_limits.y - range_limits.x), 0.0, 1.0);
    return texture2D(scale, vec2(0.12 + 0.88 * part, 0.5)).rgb;
  }
  void main() {
    float range = length(position);
    colour = by_residual ? residual_colour(range) : range_colour(range);
    vec4 seen = modelViewMatrix * vec4(position, 1.0);
    gl_PointSize = clamp(size_factor * range / -seen.z, 1.5 * pixel_ratio, largest * pixel_ratio);
    seen.z += towards_camera;
    gl_Position = projectionMatrix * seen;
  }`;
const fragmentText = `
  varying vec3 colour;
  void main() { gl_FragColor = vec4(colour, 1.0); }`;

function scaleTexture() {
  const texture = new THREE.DataTexture(scaleTable, scaleTable.length / 3, 1, THREE.RGBFormat);
  texture.magFilter = texture.minFilter = THREE.NearestFilter;
  texture.needsUpdate = true;
  return texture;
}

export class PointCloud {
  constructor() {
    this.uniforms = {
      size_factor: { value: 1 }, pixel_ratio: { value: 1 }, largest: { value: 4 }, towards_camera: { value: 0 }, half_slope: { value: 0.1 },
      residual_limit: { value: RESIDUAL_LIMIT_M }, range_limits: { value: new THREE.Vector2(0, 1) },
      by_residual: { value: false }, surface: { value: null }, scale: { value: scaleTexture() },
      nearer: { value: new THREE.Color(sceneColours.nearer) }, farther: { value: new THREE.Color(sceneColours.farther) },
      agrees: { value: new THREE.Color(sceneColours.agrees) }, no_surface: { value: new THREE.Color(sceneColours.noSurface) },
    };
    const material = new THREE.ShaderMaterial({ uniforms: this.uniforms, vertexShader: vertexText, fragmentShader: fragmentText });
    this.object = new THREE.Points(new THREE.BufferGeometry(), material);
    this.object.frustumCulled = false;
    this.count = 0;
    this.spacing = 0;  // between rays, at a range of one metre
    this.rays = 0;
    this.fov = 0;
    this.nearest = 0;
    this.farthest = 0;
    this.reserve(FIRST_CAPACITY);
  }

  reserve(points) {
    this.positions = new Float32Array(3 * points);
    this.attribute = new THREE.BufferAttribute(this.positions, 3).setUsage(THREE.DynamicDrawUsage);
    this.object.geometry.dispose();
    this.object.geometry = new THREE.BufferGeometry().setAttribute('position', this.attribute);
    this.object.geometry.setDrawRange(0, 0);
  }

  // The directions change only when the sensor does.
  layRays(rays, fov) {
    if (rays === this.rays && fov === this.fov) return;
    this.rays = rays;
    this.fov = fov;
    const slope = Math.tan(0.5 * fov);
    this.directions = new Float32Array(3 * rays * rays);
    let at = 0;
    for (let row = 0; row < rays; ++row)
      for (let column = 0; column < rays; ++column) {
        const x = slope * ((2 * column + 1) / rays - 1);
        const z = slope * (1 - (2 * row + 1) / rays);
        const length = Math.sqrt(x * x + 1 + z * z);
        this.directions[at++] = x / length;
        this.directions[at++] = 1 / length;
        this.directions[at++] = z / length;
      }
    if (3 * rays * rays > this.positions.length) this.reserve(rays * rays);
    this.spacing = (2 * slope) / rays;
    this.uniforms.half_slope.value = slope;
  }

  show(frame) {
    this.count = 0;
    if (frame) {
      this.layRays(frame.rays, frame.fov);
      this.place(frame.ranges);
    }
    this.attribute.updateRange.count = 3 * this.count;
    this.attribute.needsUpdate = this.count > 0;
    this.object.geometry.setDrawRange(0, this.count);
  }

  place(ranges) {
    const { positions, directions } = this;
    let nearest = 65535, farthest = 0, at = 0;
    for (let i = 0; i < ranges.length; ++i) {
      const units = ranges[i];
      if (units === 0) continue;
      if (units < nearest) nearest = units;
      if (units > farthest) farthest = units;
      const range = units * RANGE_UNIT_M;
      positions[at++] = range * directions[3 * i];
      positions[at++] = range * directions[3 * i + 1];
      positions[at++] = range * directions[3 * i + 2];
    }
    this.count = at / 3;
    this.nearest = nearest * RANGE_UNIT_M;
    this.farthest = Math.max(farthest, nearest + 1) * RANGE_UNIT_M;
    this.uniforms.range_limits.value.set(this.nearest, this.farthest);
  }

  /** The mean place of the points, where nothing better is known about the target's. */
  centre(result) {
    result.set(0, 0, 0);
    for (let i = 0; i < 3 * this.count; i += 3) {
      result.x += this.positions[i];
      result.y += this.positions[i + 1];
      result.z += this.positions[i + 2];
    }
    return result.divideScalar(Math.max(1, this.count));
  }

  /** As large as the gaps between the rays are on the screen. */
  setScreen(pixelsHigh, pixelRatio, largest, camera) {
    const pixelsAtOneMetre = pixelsHigh / (2 * Math.tan(0.5 * THREE.Math.degToRad(camera.fov)));
    this.uniforms.pixel_ratio.value = pixelRatio;
    this.uniforms.largest.value = largest;
    this.uniforms.size_factor.value = 0.85 * this.spacing * pixelsAtOneMetre;
  }
}
