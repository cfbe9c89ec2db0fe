// The data of the page: arrays in base64 (little-endian), tables, and the states of a sheet.

/** Part of the largest number of a column below which a number is a rounding error. */
const ROUNDING = 1e-12;

function bytes(text) {
    const raw = atob(text);
    const found = new Uint8Array(raw.length);
    for (let k = 0; k < raw.length; k += 1) {
        found[k] = raw.charCodeAt(k);
    }
    return found;
}

/** The arrays of the page; each is decoded when it is first asked for. */
export class Arrays {
    constructor(texts) {
        this.texts = texts;
        this.decoded = new Map();
    }

    bytes(place) {
        if (!this.decoded.has(place)) {
            this.decoded.set(place, bytes(this.texts[place]));
        }
        return this.decoded.get(place);
    }

    floats(place) {
        return new Float32Array(this.bytes(place).buffer);
    }

    indices(place) {
        return new Uint32Array(this.bytes(place).buffer);
    }
}

/** A table of a study: columns by name, each an array of numbers (NaN where there is none) or of words. */
export class Table {
    constructor(arrays, { name, rows, columns, left_out: leftOut }) {
        this.name = name;
        this.rows = rows;
        this.leftOut = leftOut;
        this.columns = new Map();
        this.words = new Map();
        /** Names of columns in the words of the study. */
        this.said = {};
        for (const column of columns) {
            if (column.words) {
                this.words.set(column.name, column.words);
            } else {
                const { scale, array } = column.numbers;
                this.columns.set(column.name, Float64Array.from(arrays.floats(array), (part) => part * scale));
            }
        }
    }

    /** Names of the columns with at least one number. */
    names() {
        return [...this.columns.keys()].filter((name) => this.columns.get(name).some(Number.isFinite));
    }

    /** The name of a column as words. */
    spoken(name) {
        return this.said[name] ?? spoken(name);
    }

    /** A column as a plot shows it: arc lengths of the negative direction of a branch are negative. */
    plotted(name) {
        const values = this.columns.get(name);
        const sign = this.columns.get("sign");
        return name === "arc_length" && sign ? values.map((value, row) => value * (sign[row] < 0 ? -1 : 1)) : values;
    }

    /** A number of the table, 0 where it is a rounding error of the largest of its column; undefined where there is none. */
    clean(name, row) {
        const values = this.columns.get(name);
        const largest = values?.reduce((most, value) => (Number.isFinite(value) ? Math.max(most, Math.abs(value)) : most), 0);
        return Math.abs(values?.[row]) < ROUNDING * largest ? 0 : values?.[row];
    }

    /** The rows as pieces, each of one branch and direction, or of one mode or pair of wells. */
    pieces() {
        const names = ["branch", "sign", "mode", "nappe", "from", "to"];
        const keys = names.map((name) => this.columns.get(name)).filter(Boolean);
        const key = (row) => keys.map((values) => values[row]).join(" ");
        const found = [];
        for (let row = 0; row < this.rows; row += 1) {
            if (row === 0 || key(row) !== key(row - 1)) {
                found.push([]);
            }
            found[found.length - 1].push(row);
        }
        // a table that numbers its rows, as that of eigenvalues, is one piece
        return found.length < this.rows ? found : [found.flat()];
    }

    /** The numbers and words of a row, without fold angles: pairs of a name and a text. */
    row(row) {
        const numbers = [...this.columns].filter(([name]) => !name.startsWith("fold_"));
        const found = numbers.map(([name, values]) => [name, Number.isFinite(values[row]) ? short(values[row]) : ""]);
        const words = [...this.words].map(([name, values]) => [name, values[row]]);
        return [...found, ...words].filter(([, text]) => text !== "");
    }
}

/** A number with five digits, with a true minus sign. */
export function short(number) {
    if (typeof number !== "number") {
        return String(number);
    }
    const size = Math.abs(number);
    const rounded = Number(number.toPrecision(5));
    const text = size !== 0 && (size < 1e-3 || size >= 1e6) ? rounded.toExponential() : String(rounded);
    return text.replace(/-/g, "\u2212").replace("e+", "e");
}

/** A name of a column as words. */
export function spoken(name) {
    return name.replace(/_/g, " ");
}

/** What a fold angle beyond pi means: the faces beside the crease have passed through each other. */
export function turns(angle) {
    const size = Math.abs(angle) - 1e-6;
    return size > 2 * Math.PI ? ", more than a turn" : size > Math.PI ? ", more than half a turn" : "";
}

/** The states of a sheet: positions in units of its size, and values on its lines. */
export class States {
    constructor(arrays, sheet) {
        this.arrays = arrays;
        this.sheet = sheet;
        this.fields = sheet.fields.map((field) => field.name);
    }

    mesh(state) {
        const mesh = this.sheet.meshes[this.sheet.states[state].mesh];
        return Object.fromEntries(Object.entries(mesh).map(([name, place]) => [name, this.arrays.indices(place)]));
    }

    /** Positions about the middle of the state, or, in place, about that of the first state; those of a mode are moved so
     *  far that its largest displacement is `amplitude`. */
    points(state, amplitude, inPlace = false) {
        const { points, displacement, offset } = this.sheet.states[state];
        const found = Float32Array.from(this.arrays.floats(points), (x, k) => (inPlace ? x + offset[k % 3] : x));
        if (displacement === undefined) {
            return found;
        }
        const rates = this.arrays.floats(displacement);
        let largest = 0;
        for (let k = 0; k + 2 < rates.length; k += 3) {
            largest = Math.max(largest, Math.hypot(rates[k], rates[k + 1], rates[k + 2]));
        }
        return largest > 0 ? found.map((place, k) => place + (amplitude / largest) * rates[k]) : found;
    }

    crossing(state) {
        const place = this.sheet.states[state].crossing;
        return place === undefined ? null : this.arrays.bytes(place);
    }

    /** The values of a field, one for each line. */
    values(state, name) {
        const at = this.fields.indexOf(name);
        const { line, edge } = this.sheet.states[state].values[at];
        const { scale } = this.sheet.fields[at];
        if (line !== undefined) {
            return Float64Array.from(this.arrays.floats(line), (part) => part * scale);
        }
        const ofEdge = this.arrays.floats(edge);
        return Float64Array.from(this.mesh(state).edges, (number) => ofEdge[number] * scale);
    }
}
