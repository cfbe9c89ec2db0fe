// Plots: a line for each piece of a table, ticks at round numbers, and a dot at the state that is shown.

import { short } from "foldwell/data";

const [WIDTH, HEIGHT] = [368, 210];
const FRAME = { left: 62, right: 356, top: 10, bottom: 176 };
/** Number of rows up to which they are marked one by one. */
const FEW = 60;
/** Range of positive values, as a ratio, above which an axis is logarithmic, and the part of them below the middle of that
 *  range: a single small value, as a zero with rounding errors, does not count. */
const WIDE = 1e4;
const SPREAD = 0.15;

function element(name, attributes, words) {
    const found = document.createElementNS("http://www.w3.org/2000/svg", name);
    Object.entries(attributes).forEach(([key, value]) => found.setAttribute(key, value));
    if (words !== undefined) {
        found.textContent = words;
    }
    return found;
}

/** Round numbers in a range, about `count` of them. */
function ticks(low, high, count) {
    const raw = (high - low) / count;
    const unit = 10 ** Math.floor(Math.log10(raw));
    const step = unit * [1, 2, 5, 10].find((times) => times * unit >= raw);
    const found = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1) {
        found.push(k * step);
    }
    return found;
}

/** An axis from the numbers on it to a range of the paper. */
class Axis {
    constructor(values, from, to) {
        const finite = values.filter(Number.isFinite);
        let [low, high] = finite.reduce(([a, b], value) => [Math.min(a, value), Math.max(b, value)], [Infinity, -Infinity]);
        if (!(low <= high)) {
            [low, high] = [0, 1];
        }
        const small = finite.filter((value) => value * value < low * high).length;
        this.log = low > 0 && high / low > WIDE && small > SPREAD * finite.length;
        if (this.log) {
            [low, high] = [Math.log10(low), Math.log10(high)];
        }
        const size = Math.max(Math.abs(low), Math.abs(high));
        // what differs by rounding only is drawn as one value
        if (high - low <= 1e-6 * size || high === low) {
            const half = size > 0 ? 0.5 * size : 0.5;
            [low, high] = [low - half, high + half];
        }
        const margin = 0.04 * (high - low);
        Object.assign(this, { low: low - margin, high: high + margin, from, to });
    }

    place(value) {
        const part = ((this.log ? Math.log10(value) : value) - this.low) / (this.high - this.low);
        return this.from + part * (this.to - this.from);
    }

    ticks(count) {
        if (!this.log) {
            return ticks(this.low, this.high, count).map((value) => [value, short(Math.abs(value) < 1e-12 * this.high ? 0 : value)]);
        }
        const every = Math.max(1, Math.ceil((this.high - this.low) / count));
        const first = Math.ceil(this.low / every) * every;
        const powers = Array.from({ length: Math.floor((this.high - first) / every) + 1 }, (_, k) => first + k * every);
        return powers.map((power) => [10 ** power, `1e${String(power).replace("-", "\u2212")}`]);
    }
}

/** A plot of two columns of a table. */
export class Chart {
    constructor(colours) {
        this.colours = colours;
        this.svg = element("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img" });
    }

    draw(table, [x, y]) {
        const [right, up] = [table.plotted(x), table.plotted(y)];
        this.svg.replaceChildren();
        this.svg.setAttribute("aria-label", `${table.spoken(y)} over ${table.spoken(x)}`);
        this.values = [right, up];
        this.axes = [new Axis(right, FRAME.left, FRAME.right), new Axis(up, FRAME.bottom, FRAME.top)];
        this.#frame([table.spoken(x), table.spoken(y)]);
        this.#series(table);
        this.dot = element("circle", { class: "dot", r: 5, visibility: "hidden" });
        this.svg.append(this.dot);
    }

    /** Moves the dot to a row; without a row, or where the row has no such values, there is no dot. */
    mark(row) {
        const place = row === null ? null : this.#place(row);
        this.dot.setAttribute("visibility", place ? "visible" : "hidden");
        if (place) {
            this.dot.setAttribute("cx", place[0].toFixed(1));
            this.dot.setAttribute("cy", place[1].toFixed(1));
        }
    }

    #place(row) {
        const place = this.axes.map((axis, k) => axis.place(this.values[k][row]));
        return place.every(Number.isFinite) ? place : null;
    }

    #frame([x, y]) {
        const { left, right, top, bottom } = FRAME;
        const [across, upwards] = this.axes;
        for (const [value, words] of across.ticks(4)) {
            const place = across.place(value);
            this.svg.append(element("path", { class: "grid", d: `M${place} ${top}V${bottom}` }));
            this.svg.append(element("text", { x: place, y: bottom + 15, "text-anchor": "middle" }, words));
        }
        for (const [value, words] of upwards.ticks(4)) {
            const place = upwards.place(value);
            this.svg.append(element("path", { class: "grid", d: `M${left} ${place}H${right}` }));
            this.svg.append(element("text", { x: left - 5, y: place + 4, "text-anchor": "end" }, words));
        }
        this.svg.append(element("rect", { class: "grid", x: left, y: top, width: right - left, height: bottom - top }));
        this.svg.append(element("text", { x: (left + right) / 2, y: HEIGHT - 4, "text-anchor": "middle" }, x));
        const middle = `translate(11 ${(top + bottom) / 2}) rotate(-90)`;
        this.svg.append(element("text", { transform: middle, "text-anchor": "middle" }, y));
    }

    #series(table) {
        const branch = table.columns.get("branch");
        table.pieces().forEach((rows, number) => {
            const known = branch ? branch[rows[0]] : number;
            const colour = this.colours[(Number.isFinite(known) ? known : number) % this.colours.length];
            const places = rows.map((row) => this.#place(row)).filter(Boolean);
            const steps = places.slice(1).map((place, k) => place[0] - places[k][0]);
            const isCurve = Boolean(branch) || steps.every((step) => step > 0) || steps.every((step) => step < 0);
            if (isCurve && places.length > 1) {
                const path = places.map(([a, b]) => `${a.toFixed(1)} ${b.toFixed(1)}`).join("L");
                this.svg.append(element("path", { class: "series", d: `M${path}`, stroke: colour }));
            }
            if (!isCurve || places.length <= FEW) {
                const radius = isCurve ? 2.4 : 1.4;
                places.forEach(([cx, cy]) => this.svg.append(element("circle", { cx, cy, r: radius, fill: colour })));
            }
        });
    }
}
