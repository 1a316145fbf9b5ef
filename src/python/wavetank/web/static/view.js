/* The tank, the bodies and the water, drawn by three.js. z is up. */
"use strict";

const SPEED_COLOURS = ["#1a55b5", "#2a86dc", "#55b8ea", "#a8e4f2", "#fdf6d8"];  // from rest to the fastest
const WATER = 0x3a9ae8;  // of the surface
const BAR = 40;  // pixels, of what lies over the canvas
const LABEL_HEIGHT = 19;  // pixels, its margin too
const GROUND = 0x0d1620;
const MARKER = { CUBE: 1, SPHERE: 2, CYLINDER: 3, LINE_STRIP: 4, LINE_LIST: 5, TEXT: 9, MESH: 10, TRIANGLES: 11 };  // of visualization_msgs/Marker

const POINT_SHADER = {
  vertexShader: `
    precision highp float;
    attribute vec4 position;  // in parts of the box, and the speed in parts of the greatest
    uniform mat4 modelViewMatrix, projectionMatrix;
    uniform vec3 low, size;
    uniform float diameter, height, factor;
    uniform vec3 colours[5];
    varying vec3 shade;
    void main() {
      vec4 seen = modelViewMatrix * vec4(low + position.xyz * size, 1.0);
      gl_Position = projectionMatrix * seen;
      gl_PointSize = clamp(diameter * height * projectionMatrix[1][1] * 0.5 / gl_Position.w, 1.5, 64.0);  // LEAST_PIXELS, MOST_PIXELS
      float at = clamp(position.w * factor, 0.0, 1.0) * 4.0;
      shade = mix(colours[0], colours[1], clamp(at, 0.0, 1.0));
      shade = mix(shade, colours[2], clamp(at - 1.0, 0.0, 1.0));
      shade = mix(shade, colours[3], clamp(at - 2.0, 0.0, 1.0));
      shade = mix(shade, colours[4], clamp(at - 3.0, 0.0, 1.0));
    }`,
  fragmentShader: `
    precision mediump float;
    varying vec3 shade;
    void main() {
      vec2 at = 2.0 * gl_PointCoord - 1.0;
      float away = dot(at, at);
      if (away > 1.0) discard;
      gl_FragColor = vec4(shade * (0.72 + 0.28 * (sqrt(1.0 - away) - 0.5 * at.y - 0.3 * at.x)), 1.0);
    }`,
};

// Where the processor draws: a picture costs it most of all the pixels of the balls, and one without `discard` hides what lies behind it.
const PLAIN_FRAGMENT_SHADER = `
    precision mediump float;
    varying vec3 shade;
    void main() { gl_FragColor = vec4(shade * (1.08 - 0.3 * gl_PointCoord.y), 1.0); }`;
const LONGEST = 1000 / 8;  // ms a picture: where it takes longer only some of the particles are drawn
const FEW = 20000;  // particles, that are all drawn however long it takes
const LEAST_PIXELS = 1.5, MOST_PIXELS = 64;  // across a particle
const MOST_LEFT_OUT = 8;  // one in so many is drawn at least

/** A round number that is not less. */
function roundUp(value) {
  const power = Math.pow(10, Math.floor(Math.log10(value)));
  return [1, 1.5, 2, 3, 4, 5, 6, 8, 10].map((each) => each * power).find((each) => each >= value * 0.999999);
}

/** Of points of four numbers of 16 bits, every such one. */
function oneIn(every, points) {
  if (every === 1) return points;
  const all = new Uint32Array(points.buffer, points.byteOffset, points.length / 2);  // two a point
  const some = new Uint32Array(2 * Math.ceil(all.length / (2 * every)));
  for (let from = 0, to = 0; from < all.length; from += 2 * every, to += 2) {
    some[to] = all[from];
    some[to + 1] = all[from + 1];
  }
  return new Uint16Array(some.buffer);
}

/** Of points of four numbers of 16 bits those that a picture shows: the others are out of it, or wholly behind nearer ones. Whoever draws them all gets the same pixels.
 * toClip: from the numbers to clip coordinates, whose w is the distance; reach: pixels · m, a point's size by its distance. */
function inSight(points, toClip, width, height, reach) {
  const m = toClip.elements, count = points.length / 4;
  const x = new Float32Array(count), y = new Float32Array(count), away = new Float32Array(count), half = new Float32Array(count);
  let least = MOST_PIXELS;
  for (let i = 0, at = 0; i < count; ++i, at += 4) {
    const a = points[at], b = points[at + 1], c = points[at + 2], w = m[3] * a + m[7] * b + m[11] * c + m[15];
    away[i] = w;
    if (w <= 0) continue;
    x[i] = (0.5 + 0.5 * (m[0] * a + m[4] * b + m[8] * c + m[12]) / w) * width;
    y[i] = (0.5 + 0.5 * (m[1] * a + m[5] * b + m[9] * c + m[13]) / w) * height;
    half[i] = 0.5 * Math.min(Math.max(reach / w, LEAST_PIXELS), MOST_PIXELS);
    if (2 * half[i] < least) least = 2 * half[i];
  }
  const cell = least / 3, columns = Math.ceil(width / cell), rows = Math.ceil(height / cell);  // so that every point covers some cells wholly
  const nearest = new Float32Array(columns * rows).fill(Infinity);
  for (let i = 0; i < count; ++i) {
    if (away[i] <= 0) continue;
    const left = Math.max(Math.ceil((x[i] - half[i]) / cell), 0), right = Math.min(Math.floor((x[i] + half[i]) / cell), columns);
    const low = Math.max(Math.ceil((y[i] - half[i]) / cell), 0), high = Math.min(Math.floor((y[i] + half[i]) / cell), rows);
    for (let row = low; row < high; ++row)
      for (let at = row * columns + left, end = row * columns + right; at < end; ++at)
        if (away[i] < nearest[at]) nearest[at] = away[i];
  }
  const all = new Uint32Array(points.buffer, points.byteOffset, 2 * count), some = new Uint32Array(2 * count);  // two a point
  let kept = 0;
  for (let i = 0; i < count; ++i) {
    if (away[i] <= 0) continue;
    const left = Math.max(Math.floor((x[i] - half[i]) / cell), 0), right = Math.min(Math.floor((x[i] + half[i]) / cell), columns - 1);
    const low = Math.max(Math.floor((y[i] - half[i]) / cell), 0), high = Math.min(Math.floor((y[i] + half[i]) / cell), rows - 1);
    let seen = false;
    for (let row = low; row <= high && !seen; ++row)
      for (let at = row * columns + left, end = row * columns + right; at <= end && !seen; ++at) seen = away[i] <= nearest[at];
    if (!seen) continue;
    some[kept++] = all[2 * i];
    some[kept++] = all[2 * i + 1];
  }
  return new Uint16Array(some.buffer, 0, 2 * kept);
}

/** Whether the processor draws, for which smooth edges are too dear. */
function drawnByProcessor() {
  const context = document.createElement("canvas").getContext("webgl");
  const named = context && context.getExtension("WEBGL_debug_renderer_info");
  const name = named ? context.getParameter(named.UNMASKED_RENDERER_WEBGL) : "";
  if (context) context.getExtension("WEBGL_lose_context").loseContext();
  return /swiftshader|llvmpipe|softpipe|software/i.test(name);
}

class View {
  constructor(canvas) {
    this.canvas = canvas;
    this.slow = drawnByProcessor();
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !this.slow });
    this.renderer.setClearColor(GROUND);
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(32, 1, 0.01, 1000);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.redraw());
    this.controls.addEventListener("start", () => { this.home = null; });
    canvas.addEventListener("wheel", () => { this.home = null; });
    this.tank = new THREE.Group();  // moves where the tank does
    this.scene.add(this.tank);
    this.drawn = new Map();  // groups by body, "" the tank's own frame
    this.names = [];
    this.showNames = true;
    this.box = new THREE.Box3();
    this.dimensions = 3;
    this.framed = false;
    this.range = null;  // m/s of the last colour; null: by what is there
    this.typical = 0;
    this.frames = 0;
    this.every = 1;  // one in so many particles is drawn
    this.given = 0;  // particles, of the last cloud
    this.cost = this.paced = 0;  // ms a picture, of the last ones; how many since `every` changed
    this.diameter = 0.01;  // m, of a particle
    this._addLights();
    this._addWater();
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
    const loop = (now) => {
      requestAnimationFrame(loop);
      this._pace(now);
      if (this.dirty) {
        this.dirty = false;
        if (this.water.visible && (this.stale || this.slow)) this._fillWater();  // from elsewhere other particles are seen
        this.renderer.render(this.scene, this.camera);
        this.frames += 1;
        this.drewAt = now;
      }
    };
    requestAnimationFrame(loop);
  }

  /** What a picture takes is seen by when the browser asks for the next one. */
  _pace(now) {
    const drewAt = this.drewAt;
    this.drewAt = null;
    if (!drewAt || !this.slow || !this.water.visible || document.hidden) return;
    this.cost += 0.2 * (Math.min(now - drewAt, 1000) - this.cost);
    if (++this.paced < 10) return;
    if (this.cost > LONGEST && this.every < MOST_LEFT_OUT && this.given > FEW) this.every += 1;
    else if (this.every > 1 && this.cost * this.every / (this.every - 1) < 0.7 * LONGEST) this.every -= 1;
    else return;
    this.paced = 0;
  }

  redraw() { this.dirty = true; }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height) return;
    this.renderer.setPixelRatio(this.slow ? 1 : Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.water.material.uniforms.height.value = height * this.renderer.getPixelRatio();
    this.names.forEach((label) => this._sizeLabel(label));
    if (this.home) this.look(this.home);
    this.redraw();
  }

  _addLights() {
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x90a0b0, 0.85));
    const sun = new THREE.DirectionalLight(0xffffff, 0.55);
    sun.position.set(-0.5, -1, 1.4);
    this.scene.add(sun);
  }

  _addWater() {
    const uniforms = {
      low: { value: new THREE.Vector3() }, size: { value: new THREE.Vector3() }, diameter: { value: 0.01 }, height: { value: 1 }, factor: { value: 0 },
      colours: { value: SPEED_COLOURS.map((colour) => new THREE.Color(colour)) },
    };
    this.water = new THREE.Points(new THREE.BufferGeometry(), new THREE.RawShaderMaterial({ uniforms, ...POINT_SHADER, ...(this.slow ? { fragmentShader: PLAIN_FRAGMENT_SHADER } : {}) }));
    this.water.frustumCulled = false;
    this.water.visible = false;
    this.tank.add(this.water);
    this.surface = new THREE.Mesh(
      new THREE.BufferGeometry(),
      new THREE.MeshPhongMaterial({ color: WATER, specular: 0x88aacc, shininess: 70, transparent: true, opacity: 0.88, side: THREE.DoubleSide }));
    this.spray = new THREE.Points(new THREE.BufferGeometry(), new THREE.PointsMaterial({ color: 0xd8ecfa, size: 0.01 }));
    for (const part of [this.surface, this.spray]) {
      part.frustumCulled = false;
      part.visible = false;
      this.tank.add(part);
    }
  }

  // ---------------------------------------------------------------- water

  showCloud(packet) {
    this.given = packet.points.length / 4;
    this.points = oneIn(this.given > FEW ? this.every : 1, packet.points);
    const count = this.points.length / 4;
    const uniforms = this.water.material.uniforms;
    uniforms.low.value.fromArray(packet.low);
    uniforms.size.value.fromArray(packet.size);
    uniforms.diameter.value = this.diameter * Math.pow(this.given / Math.max(count, 1), 1 / this.dimensions);
    this.top = packet.top_speed;  // m/s, of the fastest particle
    this._follow(packet.typical_speed);
    this.water.visible = true;
    this.surface.visible = this.spray.visible = false;
    this.count = count;
    this._frame(packet);
    this.placeBodies(packet.poses);
    this.stale = true;
    this.redraw();
  }

  /** The points of the last cloud into the array that is drawn; where the processor draws, those in sight alone. */
  _fillWater() {
    this.stale = false;
    let points = this.points;
    if (this.slow && points.length > 4 * FEW) {
      const { low, size, diameter, height } = this.water.material.uniforms;
      this.camera.updateMatrixWorld();
      this.tank.updateMatrixWorld(true);
      const toBox = new THREE.Matrix4().makeTranslation(low.value.x, low.value.y, low.value.z).scale(size.value.clone().multiplyScalar(1 / 65535));
      const toClip = new THREE.Matrix4().multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse).multiply(this.tank.matrixWorld).multiply(toBox);
      points = inSight(points, toClip, this.canvas.width, this.canvas.height, diameter.value * height.value * this.camera.projectionMatrix.elements[5] * 0.5);
    }
    const geometry = this.water.geometry, count = points.length / 4;
    let held = geometry.getAttribute("position");
    if (!held || held.count < count) {  // with some room, since their number changes
      geometry.dispose();
      held = new THREE.BufferAttribute(new Uint16Array(4 * Math.ceil(count * 1.25 + 64)), 4, true);
      held.setUsage ? held.setUsage(35048) : (held.dynamic = true);
      geometry.setAttribute("position", held);
    }
    held.array.set(points);
    held.updateRange.count = points.length;
    held.needsUpdate = true;
    geometry.setDrawRange(0, count);
  }

  showSurface(packet) {
    const geometry = new THREE.BufferGeometry();
    const count = packet.points.length / 4, places = new Float32Array(3 * count);
    for (let i = 0; i < count; ++i)
      for (let axis = 0; axis < 3; ++axis) places[3 * i + axis] = packet.low[axis] + packet.points[4 * i + axis] / 65535 * packet.size[axis];
    geometry.setAttribute("position", new THREE.BufferAttribute(places, 3));
    geometry.setIndex(new THREE.BufferAttribute(packet.corners, 1));
    const material = this.surface.material;
    const coloured = Boolean(packet.colours);
    if (coloured) {
      const colours = new Float32Array(3 * count);
      for (let i = 0; i < count; ++i)
        for (let part = 0; part < 3; ++part) colours[3 * i + part] = packet.colours[4 * i + part] / 255;
      geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3));
    }
    if ((material.vertexColors === THREE.VertexColors) !== coloured) {
      material.vertexColors = coloured ? THREE.VertexColors : THREE.NoColors;
      material.color.set(coloured ? 0xffffff : WATER);
      material.needsUpdate = true;
    }
    geometry.computeVertexNormals();
    this.surface.geometry.dispose();
    this.surface.geometry = geometry;
    this.surface.visible = true;
    this.water.visible = false;
    this.count = packet.corners.length / 3;
    this._frame(packet);
    this.placeBodies(packet.poses);
    this.redraw();
  }

  showSpray(packet) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(packet.points, 3));
    this.spray.geometry.dispose();
    this.spray.geometry = geometry;
    this.spray.material.size = packet.size || 0.01;
    this.spray.visible = true;
    this.redraw();
  }

  hideWater() {
    this.water.visible = this.surface.visible = this.spray.visible = false;
    this.redraw();
  }

  set spacing(value) {
    if (value) this.water.material.uniforms.diameter.value = this.diameter = 1.15 * value;
  }

  /** The colours' range goes up with the water at once, and down slowly. */
  _follow(typical) {
    this.typical = Math.max(typical, 0.97 * this.typical);
    this.setColours();
  }

  setColours() {
    const still = 0.05 * Math.sqrt(9.81 * Math.max(this.box.max.z - this.box.min.z, 0.01));  // of the speed of waves: less is no motion worth showing
    this.greatest = this.range || roundUp(Math.max(this.typical, still || 0.01));
    this.water.material.uniforms.factor.value = (this.top || 0) / this.greatest;
    if (this.onColours) this.onColours(this.greatest);
    this.redraw();
  }

  // ---------------------------------------------------------------- tank, bodies, instruments

  draw(packet) {
    for (const group of this.drawn.values()) this._remove(group);
    this.drawn.clear();
    this.names = [];
    this.lines = [];
    for (const part of packet.parts) {
      const object = this._add(part, packet);
      if (object && object.isSprite) {
        object.visible = this.showNames;
        this.names.push(object);
      }
    }
    const box = new THREE.Box3();
    this.tank.updateMatrixWorld(true);
    for (const [body, group] of this.drawn)
      if (!body) group.children.filter((object) => object.userData.outlines).forEach((object) => box.expandByObject(object));
    if (!box.isEmpty()) {
      box.applyMatrix4(new THREE.Matrix4().getInverse(this.tank.matrixWorld));
      if (!this.hasTank || !box.equals(this.box)) { this.hasTank = true; this.box.copy(box); this.look(this.home || "home"); }
    }
    this.placeBodies(this.poses);
    this.redraw();
  }

  /** Where things were, and the water: of another tank. */
  forget() {
    this.poses = null;
    this.tank.position.set(0, 0, 0);
    this.tank.quaternion.set(0, 0, 0, 1);
    for (const [body, group] of this.drawn) group.visible = !body;
    this.typical = 0;
    this.hideWater();
  }

  /** What is drawn again and again, beside the rest. */
  drawLines(packet) {
    for (const object of this.lines || []) this._remove(object);
    this.lines = packet.parts.map((part) => this._add(part, packet)).filter((object) => object);
    this.redraw();
  }

  _add(part, packet) {
    const object = this._object(part, packet);
    if (!object) return null;
    object.position.fromArray(part.position);
    if (!object.isSprite) object.quaternion.fromArray(part.turn);
    this._groupOf(part.body).add(object);
    return object;
  }

  _remove(object) {
    if (object.parent) object.parent.remove(object);
    object.traverse((part) => {
      if (part.geometry) part.geometry.dispose();
      if (!part.material) return;
      if (part.material.map) part.material.map.dispose();
      part.material.dispose();
    });
  }

  _groupOf(body) {
    if (!this.drawn.has(body)) {
      const group = new THREE.Group();
      group.visible = !body;  // until it is told where the body is
      this.tank.add(group);
      this.drawn.set(body, group);
    }
    return this.drawn.get(body);
  }

  _object(part, packet) {
    const colour = new THREE.Color(part.colour[0], part.colour[1], part.colour[2]);
    const points = part.points && packet[part.points];
    const isTank = part.group === "tank";
    if (part.type === MARKER.TRIANGLES || part.type === MARKER.MESH) {
      if (!points) return null;
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(points.slice(), 3));
      geometry.computeVertexNormals();
      const clear = part.colour[3] < 1;
      const material = clear
        ? new THREE.MeshBasicMaterial({ color: colour, transparent: true, opacity: Math.min(part.colour[3], 0.07), depthWrite: false, side: THREE.DoubleSide })
        : new THREE.MeshPhongMaterial({ color: colour, shininess: 20, specular: 0x222222, side: THREE.DoubleSide });
      const mesh = new THREE.Mesh(geometry, material);
      mesh.scale.fromArray(part.scale);
      mesh.userData.outlines = isTank;
      mesh.renderOrder = clear ? 2 : 0;
      return mesh;
    }
    if (part.type === MARKER.LINE_LIST || part.type === MARKER.LINE_STRIP) {
      if (!points) return null;
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(points.slice(), 3));
      const material = new THREE.LineBasicMaterial({ color: colour, transparent: part.colour[3] < 1, opacity: part.colour[3] });
      const lines = part.type === MARKER.LINE_LIST ? new THREE.LineSegments(geometry, material) : new THREE.Line(geometry, material);
      lines.userData.outlines = part.group === "tank edges";
      return lines;
    }
    if (part.type === MARKER.SPHERE || part.type === MARKER.CUBE) {
      const geometry = part.type === MARKER.SPHERE ? new THREE.SphereBufferGeometry(0.5, 16, 12) : new THREE.BoxBufferGeometry(1, 1, 1);
      const mesh = new THREE.Mesh(geometry, new THREE.MeshPhongMaterial({ color: colour }));
      mesh.scale.fromArray(part.scale);
      return mesh;
    }
    return part.type === MARKER.TEXT && part.text ? this._label(part.text) : null;
  }

  _label(text) {
    const canvas = document.createElement("canvas"), size = 40;
    const pen = canvas.getContext("2d");
    const font = `500 ${size}px system-ui, "DejaVu Sans", sans-serif`;
    pen.font = font;
    canvas.width = Math.ceil(pen.measureText(text).width) + 16;
    canvas.height = size + 16;
    pen.font = font;
    pen.textBaseline = "middle";
    pen.lineWidth = 6;
    pen.strokeStyle = "rgba(13, 22, 32, .9)";
    pen.fillStyle = "#e4ecf3";
    pen.strokeText(text, 8, canvas.height / 2);
    pen.fillText(text, 8, canvas.height / 2);
    const texture = new THREE.CanvasTexture(canvas);
    texture.minFilter = THREE.LinearFilter;
    const label = new THREE.Sprite(new THREE.SpriteMaterial({ map: texture, depthTest: false, sizeAttenuation: false }));
    label.center.set(0.5, 0.2);
    label.userData.shape = canvas.width / canvas.height;
    this._sizeLabel(label);
    label.renderOrder = 3;
    return label;
  }

  /** The same on the screen, wherever it is. */
  _sizeLabel(label) {
    const height = LABEL_HEIGHT / this.canvas.clientHeight * 2 * Math.tan(THREE.Math.degToRad(this.camera.fov / 2));
    label.scale.set(height * label.userData.shape, height, 1);
  }

  setNames(shown) {
    this.showNames = shown;
    for (const label of this.names) label.visible = shown;
    this.redraw();
  }

  /** poses: by body x y z and the turn x y z w; "tank" is the tank's own in the world. */
  placeBodies(poses) {
    if (!poses) return;
    this.poses = poses;
    for (const [body, pose] of Object.entries(poses)) {
      const group = body === "tank" ? this.tank : this.drawn.get(body);
      if (!group) continue;
      group.position.set(pose[0], pose[1], pose[2]);
      group.quaternion.set(pose[3], pose[4], pose[5], pose[6]);
      group.visible = true;
    }
    this.redraw();
  }

  // ---------------------------------------------------------------- camera

  /** Of a tank that is not drawn, the first cloud's box. */
  _frame(packet) {
    if (this.hasTank || this.framed) return;
    this.framed = true;
    this.box.min.fromArray(packet.low);
    this.box.max.fromArray(packet.low.map((low, axis) => low + packet.size[axis]));
    this.look("home");
  }

  look(name) {
    if (this.box.isEmpty()) return;
    this.home = name;
    const flat = this.dimensions === 2;
    const direction = {
      home: flat ? [0, -1, 0] : [-0.55, -1, 0.55], front: [0, -1, 0], side: [1, 0, 0], top: [0, -1e-3, 1],
    }[name];
    const centre = this.box.getCenter(new THREE.Vector3()), towards = new THREE.Vector3(...direction).normalize();
    const right = new THREE.Vector3(0, 0, 1).cross(towards).normalize(), up = towards.clone().cross(right);
    const half = Math.tan(THREE.Math.degToRad(this.camera.fov / 2)), wide = half * this.camera.aspect;
    const tall = half * Math.max(0.5, 1 - 2 * BAR / this.canvas.clientHeight);  // between the buttons and the legend
    let distance = 0;
    for (let corner = 0; corner < 8; ++corner) {
      const at = new THREE.Vector3(...["x", "y", "z"].map((axis, bit) => this.box[corner >> bit & 1 ? "max" : "min"][axis])).sub(centre);
      distance = Math.max(distance, at.dot(towards) + Math.max(Math.abs(at.dot(right)) / wide, Math.abs(at.dot(up)) / tall));
    }
    distance *= 1.1;
    this.camera.near = distance / 200;
    this.camera.far = distance * 20;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).addScaledVector(towards, distance);
    this.controls.update();
    this.redraw();
  }
}
