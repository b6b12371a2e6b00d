// The target as the truth, the network, its second hypothesis and the registration place it.
import { sceneColours } from '/colours.js';

const EDGE_DEGREES = 14;  // flatter edges only clutter the wire

/** Geometry with shared corners, geometry with a normal a face, its sharp edges, and the radius about the origin. */
export function makeShape(mesh) {
  const indexed = new THREE.BufferGeometry();
  indexed.setAttribute('position', new THREE.BufferAttribute(mesh.vertices, 3));
  indexed.setIndex(new THREE.BufferAttribute(mesh.triangles, 1));
  const faces = indexed.toNonIndexed();
  faces.computeVertexNormals();
  const edges = new THREE.EdgesGeometry(indexed, EDGE_DEGREES);
  let square = 0;
  for (let i = 0; i < mesh.vertices.length; i += 3)
    square = Math.max(square, mesh.vertices[i] ** 2 + mesh.vertices[i + 1] ** 2 + mesh.vertices[i + 2] ** 2);
  return { indexed, faces, edges, radius: Math.sqrt(square) };
}

// Lit from the camera, once a corner. The materials of three.js do much more, which software rendering pays for.
const solidVertexText = `
  uniform vec3 colour;
  varying vec3 lit;
  void main() {
    vec3 turned = normalize(normalMatrix * normal);
    lit = colour * (0.4 + 0.6 * abs(dot(turned, vec3(0.31, 0.54, 0.78))));
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;
const solidFragmentText = `
  varying vec3 lit;
  void main() { gl_FragColor = vec4(lit, 1.0); }`;

function solidMaterial(colour) {
  return new THREE.ShaderMaterial({ uniforms: { colour: { value: new THREE.Color(colour) } }, vertexShader: solidVertexText,
    fragmentShader: solidFragmentText, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 2 });
}
function ghostMaterial(colour, opacity) {
  return new THREE.MeshBasicMaterial({ color: colour, side: THREE.DoubleSide, transparent: true, opacity, depthWrite: false });
}

/** At an unknown range the true body has no place. */
export function hasTruePlace(detail) {
  return Boolean(detail && detail.truth) && Number.isFinite(detail.truth.range_m);
}

class Body {
  /** `faceMaterial`: null for a body of wire alone. */
  constructor(faceMaterial, wire, isSolid = false) {
    this.isSolid = isSolid;
    this.group = new THREE.Group();
    this.group.visible = false;
    this.faces = new THREE.Mesh(new THREE.BufferGeometry(), faceMaterial || undefined);
    this.faces.visible = faceMaterial !== null;
    this.wire = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial(wire));
    this.group.add(this.faces, this.wire);
    this.isKnown = false;
    this.isOn = true;
  }

  setShape(shape) {
    this.faces.geometry = this.isSolid ? shape.faces : shape.indexed;
    this.wire.geometry = shape.edges;
  }

  /** `q`: [w, x, y, z], or null: not known at this step. */
  place(q, x, y, z) {
    this.isKnown = q !== null;
    if (q) {
      this.group.quaternion.set(q[1], q[2], q[3], q[0]);
      this.group.position.set(x, y, z);
    }
    this.refresh();
  }

  refresh() {
    this.group.visible = this.isKnown && this.isOn;
  }
}

export class Bodies {
  constructor(scene) {
    this.truth = new Body(null, { color: sceneColours.truth, transparent: true, opacity: 0.7 });
    this.network = new Body(ghostMaterial(sceneColours.network, 0.14), { color: sceneColours.network });
    this.second = new Body(ghostMaterial(sceneColours.second, 0.14), { color: sceneColours.second });
    this.pose = new Body(solidMaterial(sceneColours.pose), { color: '#1d4f91' }, true);
    this.all = [this.truth, this.network, this.second, this.pose];
    this.second.isOn = false;
    for (const body of this.all) scene.add(body.group);
  }

  setShape(shape) {
    for (const body of this.all) body.setShape(shape);
  }

  /** The best known place of the target: that of the pose, else the true one, else what `centre` holds. */
  show(detail, centre) {
    const truth = hasTruePlace(detail) ? detail.truth : null;
    const pose = detail ? detail.pose : null;
    if (pose) centre.fromArray(pose.origin_m);
    else if (truth) centre.set(0, truth.range_m, 0);
    this.truth.place(truth ? truth.q : null, 0, truth ? truth.range_m : 0, 0);
    this.pose.place(pose ? pose.q : null, centre.x, centre.y, centre.z);
    // The network gives attitudes only; its meshes stand where the target is.
    for (const name of ['network', 'second']) {
      const estimate = detail ? detail[name] : null;
      this[name].place(estimate ? estimate.q : null, centre.x, centre.y, centre.z);
    }
  }

  /** The body whose attitude is the best one known, or null. */
  best() {
    return [this.pose, this.truth, this.network].find((body) => body.isKnown) || null;
  }
}
