// The sheet in space: faces with light, edges as tubes that are thicker the sharper they are folded, and axes.

import {
    AmbientLight, BackSide, BufferAttribute, BufferGeometry, Color, CylinderGeometry, DirectionalLight, FrontSide, Group,
    InstancedMesh, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, OrbitControls, OrthographicCamera, Quaternion,
    Raycaster, Scene, SRGBColorSpace, Vector2, Vector3, WebGLRenderer,
} from "three";

const [CREASE, FACET, BOUNDARY] = [0, 1, 2];
/** Numbers of the letters of creases that are to fold. */
const [MOUNTAIN, VALLEY] = [1, 2];
/** Fold angle in radians below which a crease is drawn as flat, as in drawings. */
const FLAT = 1e-6;
/** Strains below this are rounding errors. */
const ROUNDING = 1e-12;
/** Part of the canvas that the largest state takes in the first view. */
const FILLED = 0.86;

/** Returns the linear components of a colour between the colours of a scale, at a part from 0 to 1. */
function mixed(ramp, part) {
    const place = Math.min(Math.max(part, 0), 1) * (ramp.length - 1);
    const first = Math.min(Math.floor(place), ramp.length - 2);
    const [a, b] = [ramp[first], ramp[first + 1]].map((colour) => new Color(colour).convertLinearToSRGB());
    return new Color().setRGB(...["r", "g", "b"].map((k) => a[k] + (b[k] - a[k]) * (place - first)), SRGBColorSpace);
}

/** What colours mean: a range of numbers and the colours of a scale, symmetric about zero for numbers of both signs. */
export class Scale {
    constructor(palette, low, high, signed = palette.signed, always = false) {
        const largest = Math.max(Math.abs(low), Math.abs(high));
        const isSigned = always || low < -1e-9 * largest;
        this.low = isSigned ? -largest : 0;
        this.high = largest;
        this.ramp = isSigned ? signed : palette.energy;
        this.steps = Array.from({ length: 257 }, (_, k) => mixed(this.ramp, k / 256));
    }

    colour(value) {
        const range = this.high - this.low;
        return this.steps[range > 0 ? Math.round((256 * (value - this.low)) / range) : Math.round(128 * (this.low < 0))];
    }
}

/** Mean curvature of each face: a quarter of fold angle times length over its sides, over its area. */
export function meanCurvature({ triangles, sides, lines }, points, angles) {
    const place = (k) => new Vector3().fromArray(points, 3 * k);
    return Float64Array.from({ length: triangles.length / 3 }, (_, face) => {
        const [a, b, c] = [0, 1, 2].map((k) => place(triangles[3 * face + k]));
        const area = 0.5 * b.sub(a).cross(c.sub(a)).length();
        let sum = 0;
        for (const line of sides[face]) {
            const angle = angles[line];
            if (Number.isFinite(angle)) {
                sum += angle * place(lines[2 * line]).distanceTo(place(lines[2 * line + 1]));
            }
        }
        return (0.25 * sum) / area;
    });
}

/** Adds to a mesh the lines at the sides of each of its triangles. */
export function withSides(mesh) {
    const name = (a, b) => (a < b ? `${a} ${b}` : `${b} ${a}`);
    const lines = new Map();
    for (let line = 0; 2 * line < mesh.lines.length; line += 1) {
        lines.set(name(mesh.lines[2 * line], mesh.lines[2 * line + 1]), line);
    }
    const sides = Array.from({ length: mesh.triangles.length / 3 }, (_, face) => {
        const [a, b, c] = [0, 1, 2].map((k) => mesh.triangles[3 * face + k]);
        return [name(a, b), name(b, c), name(c, a)].map((side) => lines.get(side)).filter((line) => line !== undefined);
    });
    return { ...mesh, sides };
}

/** Mean of the numbers on the sides of each face; NaN where there is none. */
function onFaces({ sides }, values) {
    return Float64Array.from(sides, (lines) => {
        const known = lines.map((line) => values[line]).filter(Number.isFinite);
        return known.length ? known.reduce((a, b) => a + b) / known.length : NaN;
    });
}

/** The view of a sheet on a canvas. */
export class SheetView {
    constructor(canvas, palette, triad) {
        Object.assign(this, { canvas, palette, triad });
        this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
        this.renderer.setClearAlpha(0);
        this.camera = new OrthographicCamera();
        const lamp = new DirectionalLight("white", 0.48 * Math.PI);
        lamp.position.set(-0.62, 0.75, 0.75);
        this.camera.add(lamp);
        this.scene = new Scene();
        this.sheet = new Group();
        this.scene.add(this.camera, new AmbientLight("white", 0.56 * Math.PI), this.sheet);
        this.controls = new OrbitControls(this.camera, canvas);
        this.controls.addEventListener("change", () => this.#ask());
        new ResizeObserver(() => this.#resize()).observe(canvas);
        this.#resize();
    }

    /** Turns the sheet so that its normal is the axis about which it is turned, and the eye stands as in drawings, so near
     *  that the positions in `extremes` are seen. */
    orient(toward, normal, extremes) {
        this.extremes = extremes;
        const up = new Vector3(...normal).normalize();
        const level = new Vector3(...toward).addScaledVector(up, -up.dot(new Vector3(...toward))).normalize();
        const frame = new Matrix4().makeBasis(new Vector3().crossVectors(up, level), up, level);
        this.sheet.quaternion.setFromRotationMatrix(frame).invert();
        this.sheet.position.copy(middle(extremes)).applyQuaternion(this.sheet.quaternion).negate();
        this.elevation = Math.asin(Math.min(1, Math.max(-1, up.dot(new Vector3(...toward).normalize()))));
        this.reset();
    }

    /** Goes back to the first view. */
    reset() {
        this.controls.target.set(0, 0, 0);
        this.camera.position.set(0, 20 * Math.sin(this.elevation), 20 * Math.cos(this.elevation));
        this.controls.update();
        this.camera.zoom = this.fit = this.#zoom();
        this.#resize();
    }

    /** The zoom at which all the positions of `extremes` are on the canvas. */
    #zoom() {
        this.camera.updateMatrixWorld();
        this.sheet.updateMatrixWorld();
        const seen = this.camera.matrixWorldInverse.clone().multiply(this.sheet.matrixWorld);
        const { right, top } = this.camera;
        let largest = 0;
        const place = new Vector3();
        for (const points of this.extremes ?? []) {
            for (let k = 0; k < points.length; k += 3) {
                place.fromArray(points, k).applyMatrix4(seen);
                const part = Math.max(Math.abs(place.x) / right, Math.abs(place.y) / top);
                largest = Number.isFinite(part) ? Math.max(largest, part) : largest;
            }
        }
        return largest > 0 ? FILLED / largest : 1;
    }

    /** Shows a mesh at these points. `angles` are the fold angles of its lines, `sharpest` the largest of all states;
     *  `painted` holds the colours of faces and lines, or is null for mountains and valleys. */
    show(mesh, points, { angles, sharpest, crossing, painted, facets, rim }) {
        if (this.mesh !== mesh) {
            this.#build(mesh);
        }
        this.points = points;
        this.#placeFaces(points);
        this.#paintFaces(crossing, painted);
        this.#placeLines(points, { angles, sharpest, painted, facets, rim });
        this.#ask();
    }

    /** Returns the places of the points that are shown, each as pixels from the upper left corner of the canvas. */
    places() {
        const { clientWidth: width, clientHeight: height } = this.canvas;
        this.camera.updateMatrixWorld();
        this.sheet.updateMatrixWorld();
        return Array.from({ length: this.points.length / 3 }, (_, k) => {
            const place = this.sheet.localToWorld(new Vector3().fromArray(this.points, 3 * k)).project(this.camera);
            return [0.5 * (1 + place.x) * width, 0.5 * (1 - place.y) * height];
        });
    }

    /** Returns the line under a place of the canvas (in pixels from its upper left corner); null if there is none. */
    lineAt(x, y) {
        const place = new Vector2((2 * x) / this.canvas.clientWidth - 1, 1 - (2 * y) / this.canvas.clientHeight);
        const ray = new Raycaster();
        ray.setFromCamera(place, this.camera);
        const [nearest] = this.tubes ? ray.intersectObjects([this.tubes, this.faces[0]], false) : [];
        return nearest && nearest.object === this.tubes ? nearest.instanceId : null;
    }

    #build(mesh) {
        for (const part of [...this.sheet.children]) {
            part.geometry.dispose();
            part.material.dispose();
            this.sheet.remove(part);
        }
        this.mesh = mesh;
        const position = new BufferAttribute(new Float32Array(3 * mesh.triangles.length), 3);
        this.faces = [FrontSide, BackSide].map((side) => {
            const geometry = new BufferGeometry();
            geometry.setAttribute("position", position);
            geometry.setAttribute("color", new BufferAttribute(new Float32Array(3 * mesh.triangles.length), 3));
            // faces lie a little behind the edges between them
            const depth = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };
            return new Mesh(geometry, new MeshLambertMaterial({ side, flatShading: true, vertexColors: true, ...depth }));
        });
        const count = mesh.lines.length / 2;
        this.tubes = new InstancedMesh(new CylinderGeometry(1, 1, 1, 8, 1), new MeshBasicMaterial(), count);
        for (const part of [...this.faces, this.tubes]) {
            part.frustumCulled = false;
            this.sheet.add(part);
        }
    }

    #placeFaces(points) {
        const { position } = this.faces[0].geometry.attributes;
        this.mesh.triangles.forEach((point, corner) => {
            position.array.set(points.subarray(3 * point, 3 * point + 3), 3 * corner);
        });
        // a triangle with a point that is not known has no area
        for (let at = 0; at < position.array.length; at += 9) {
            if (position.array.subarray(at, at + 9).some((x) => !Number.isFinite(x))) {
                position.array.fill(0, at, at + 9);
            }
        }
        position.needsUpdate = true;
        this.faces.forEach((face) => {
            face.geometry.boundingSphere = null;
        });
    }

    #paintFaces(crossing, painted) {
        const marked = new Color(this.palette.crossing);
        [this.palette.front, this.palette.back].forEach((colour, side) => {
            const { color } = this.faces[side].geometry.attributes;
            const plain = new Color(colour);
            for (let face = 0; 9 * face < color.array.length; face += 1) {
                const { r, g, b } = crossing?.[face] ? marked : (painted?.faces[face] ?? plain);
                for (let corner = 0; corner < 3; corner += 1) {
                    color.array.set([r, g, b], 9 * face + 3 * corner);
                }
            }
            color.needsUpdate = true;
        });
    }

    #placeLines(points, { angles, sharpest, painted, facets, rim }) {
        const { lines, kinds, letters } = this.mesh;
        const ends = (line) => [0, 1].map((k) => new Vector3().fromArray(points, 3 * lines[2 * line + k]));
        const unit = 0.5 * this.#unit(ends);
        const [middle, axis, turn, matrix] = [new Vector3(), new Vector3(), new Quaternion(), new Matrix4()];
        const colours = Object.fromEntries(["mountain", "valley", "grey"].map((name) => [name, new Color(this.palette[name])]));
        colours.rim = new Color(rim);
        for (let line = 0; line < kinds.length; line += 1) {
            const [a, b] = ends(line);
            const length = axis.subVectors(b, a).length();
            const known = Number.isFinite(length) && length > 0;
            const hidden = !known || (kinds[line] === FACET && !facets);
            const [width, colour] = pen(kinds[line], letters[line], angles[line], sharpest, colours);
            const radius = hidden ? 0 : unit * (painted?.lines[line] ? 1.8 : width);
            middle.addVectors(a, b).multiplyScalar(0.5);
            turn.setFromUnitVectors(new Vector3(0, 1, 0), axis.normalize());
            matrix.compose(known ? middle : new Vector3(), known ? turn : new Quaternion(), new Vector3(radius, hidden ? 0 : length, radius));
            this.tubes.setMatrixAt(line, matrix);
            this.tubes.setColorAt(line, painted?.lines[line] ?? colour);
        }
        this.tubes.instanceMatrix.needsUpdate = true;
        if (this.tubes.instanceColor) {
            this.tubes.instanceColor.needsUpdate = true;
        }
        this.tubes.boundingSphere = null;
    }

    /** The width of a line in units of the sheet's size: a part of the mean length of edges, within limits. */
    #unit(ends) {
        const count = this.mesh.kinds.length;
        let [sum, known] = [0, 0];
        for (let line = 0; line < count; line += 1) {
            const [a, b] = ends(line);
            const length = a.distanceTo(b);
            if (Number.isFinite(length)) {
                [sum, known] = [sum + length, known + 1];
            }
        }
        return Math.min(Math.max(known ? (0.03 * sum) / known : 0, 0.0014), 0.0056);
    }

    #resize() {
        const { clientWidth: width, clientHeight: height } = this.canvas;
        if (width === 0 || height === 0) {
            return;
        }
        this.renderer.setPixelRatio(window.devicePixelRatio);
        this.renderer.setSize(width, height, false);
        const [right, top] = width > height ? [width / height, 1] : [1, height / width];
        Object.assign(this.camera, { left: -right, right, top, bottom: -top, near: 0.1, far: 100 });
        // what was seen is seen in the window of another shape too
        const fit = this.#zoom();
        this.camera.zoom *= fit / (this.fit ?? fit);
        this.fit = fit;
        this.camera.updateProjectionMatrix();
        this.#ask();
    }

    #ask() {
        if (!this.asked) {
            this.asked = true;
            requestAnimationFrame(() => {
                this.asked = false;
                this.renderer.render(this.scene, this.camera);
                this.#drawTriad();
            });
        }
    }

    /** Draws the axes of the sheet's coordinates, as they are seen, in the corner; those that point to the eye last. */
    #drawTriad() {
        const turn = this.camera.quaternion.clone().invert().multiply(this.sheet.quaternion);
        const axes = ["x", "y", "z"].map((name, k) => {
            const axis = new Vector3().setComponent(k, 1).applyQuaternion(turn);
            return { name, right: 32 * axis.x, down: -32 * axis.y, near: axis.z };
        });
        axes.sort((a, b) => a.near - b.near);
        const part = ({ name, right, down }) => `<line x2="${right}" y2="${down}"/><text x="${1.3 * right}" y="${1.3 * down}">${name}</text>`;
        this.triad.innerHTML = axes.map(part).join("");
    }
}

/** The middle of the box around the positions in some arrays. */
function middle(arrays) {
    const sides = [0, 1, 2].map((axis) => {
        let [low, high] = [Infinity, -Infinity];
        for (const points of arrays) {
            for (let k = axis; k < points.length; k += 3) {
                if (Number.isFinite(points[k])) {
                    [low, high] = [Math.min(low, points[k]), Math.max(high, points[k])];
                }
            }
        }
        return low <= high ? 0.5 * (low + high) : 0;
    });
    return new Vector3(...sides);
}

/** Width and colour of a line, as in drawings: mountains red, valleys blue, the wider the sharper; a crease that is still flat
 *  has the colour of its letter. */
function pen(kind, letter, angle, sharpest, { mountain, valley, grey, rim }) {
    if (kind === BOUNDARY) {
        return [1, rim];
    }
    if (kind === FACET) {
        return [0.4, grey];
    }
    return kind === CREASE && Math.abs(angle) > FLAT
        ? [0.5 + 1.3 * Math.min(1, Math.abs(angle) / sharpest), angle < 0 ? mountain : valley]
        : [0.6, kind === CREASE ? ({ [MOUNTAIN]: mountain, [VALLEY]: valley }[letter] ?? grey) : grey];
}

/** Colours of faces and lines by a quantity on lines. */
export function paintedByLines(mesh, values, scale, name) {
    const plain = name === "strain" ? (value) => (Math.abs(value) < ROUNDING ? 0 : value) : (value) => value;
    const colours = (numbers) => Array.from(numbers, (value) => (Number.isFinite(value) ? scale.colour(plain(value)) : null));
    return { lines: colours(values), faces: colours(onFaces(mesh, values)) };
}

/** Colours of faces by a quantity on faces; lines stay as they are. */
export function paintedByFaces(values, scale) {
    return { lines: [], faces: Array.from(values, (value) => (Number.isFinite(value) ? scale.colour(value) : null)) };
}
