// The page: what is chosen, what is shown, and how keys and buttons change it.

import { Chart } from "foldwell/chart";
import { Arrays, States, Table, short, spoken, turns } from "foldwell/data";
import { Scale, SheetView, meanCurvature, paintedByFaces, paintedByLines, withSides } from "foldwell/view";

/** What is plotted first, where a study has it: the end of the table's name, the columns across and upwards. */
const PLOTS = [
    [".csv", "drive", "reaction"],
    [".csv", "drive", "energy_total"],
    [".csv", "arc_length", "curvature"],
    [".csv", "arc_length", "energy_total"],
    [".csv", "arc_length", "strain11"],
    ["history", "iteration", "energy"],
    ["history", "iteration", "residual_force"],
    [".csv", "amplitude", "energy_total"],
    [".csv", "mode", "eigenvalue"],
    ["_bands.csv", "length", "band_0"],
    [".csv", "q1", "kappa2"],
    ["-barriers.csv", "bars", "energy"],
    [".csv", "step", "energy_total"],
];
/** Number of plots beside the sheet. */
const SHOWN = 2;
const PALE = "mountain-valley";
const CURVATURE = "mean-curvature";
/** Milliseconds between two states, and the part of the sheet's size that a mode moves at most. */
const PACE = 90;
const SWING = 0.2;
/** Quantities that are red where they are positive, as the stress of mechanics: tension. */
const STRETCHED = ["strain", "tension"];
/** What the driven value of a path and its reaction are, by what is driven. */
const DRIVEN = {
    displacement: ["displacement", "force"],
    rotation: ["rotation (rad)", "torque"],
    load: ["factor of the loads", "displacement of the loads"],
    lock: ["fold angle of the lock (rad)", "torque"],
    rest: ["folded (1: as given)", "derivative of the energy"],
    stiffness: ["stiffness", "derivative of the energy"],
};
/** Letters of edges by their numbers. */
const LETTERS = "BMVFUCJ";

function options(select, entries, chosen) {
    select.replaceChildren(...entries.map(([value, words]) => new Option(words, value, false, value === chosen)));
}

function rows(table, pairs) {
    table.replaceChildren(...pairs.map(([name, text]) => {
        const row = document.createElement("tr");
        [spoken(name), text].forEach((words) => row.appendChild(document.createElement("td")).append(words));
        return row;
    }));
}

function picture(svg) {
    return `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`;
}

class Page {
    constructor(root, data) {
        Object.assign(this, { root, data, arrays: new Arrays(data.arrays), scales: new Map(), playing: null });
        this.get = (id) => root.getElementById(id);
        this.get("title").textContent = data.title;
        try {
            this.view = new SheetView(this.get("canvas"), data.palette, this.get("triad"));
        } catch {
            this.view = null;
        }
        options(this.get("study"), data.studies.map(({ name, kind }, k) => [String(k), `${name} (${kind})`]), "0");
        this.get("study").closest("label").hidden = data.studies.length < 2;
        this.#listen();
        this.#shade(matchMedia("(prefers-color-scheme: dark)").matches);
        if (data.studies.length > 0) {
            this.openStudy(0);
        } else {
            this.get("note").textContent = "There is no study to show.";
        }
    }

    #listen() {
        const on = (id, event, react) => this.get(id).addEventListener(event, react);
        on("study", "change", ({ target }) => this.openStudy(Number(target.value)));
        on("sequence", "change", ({ target }) => {
            this.openSequence(Number(target.value));
            this.#face();
        });
        on("colours", "change", () => this.draw());
        on("facets", "change", () => this.draw());
        on("follow", "change", () => this.#face());
        on("amplitude", "input", () => this.draw());
        on("slider", "input", () => this.draw());
        on("reset", "click", () => this.view?.reset());
        on("play", "click", () => this.play());
        on("theme", "click", () => this.#shade(this.root.documentElement.dataset.theme !== "dark"));
        on("canvas", "pointermove", (event) => this.#tell(event));
        this.root.addEventListener("keydown", (event) => this.#key(event));
    }

    /** Arrows move the slider wherever the focus is, except in lists and on the other slider. */
    #key(event) {
        const slider = this.get("slider");
        const busy = event.target.closest("select, #amplitude, #slider") || event.ctrlKey || event.altKey || event.metaKey;
        const moves = { ArrowLeft: -1, ArrowRight: 1, PageUp: -10, PageDown: 10, Home: -Infinity, End: Infinity };
        if (event.key === " " && !event.target.closest("button, select, summary, input[type=checkbox]")) {
            event.preventDefault();
            this.play();
        } else if (event.key in moves && !busy && this.states) {
            event.preventDefault();
            this.#go(Math.min(Math.max(Number(slider.value) + moves[event.key], 0), Number(slider.max)));
        }
    }

    #go(place) {
        this.get("slider").value = place;
        this.draw();
    }

    #shade(dark) {
        this.root.documentElement.dataset.theme = dark ? "dark" : "light";
        this.get("theme").textContent = dark ? "Light" : "Dark";
        this.draw();
    }

    /** Starts or stops the film: states one after the other, or a mode to and fro. */
    play() {
        clearInterval(this.playing);
        this.playing = this.playing || !this.states ? null : setInterval(() => this.#step(), PACE);
        this.get("play").textContent = this.playing ? "\u23f8" : "\u25b6";
        this.get("play").setAttribute("aria-label", this.playing ? "Pause" : "Play");
    }

    #step() {
        if (this.states.sheet.moving) {
            this.phase = (this.phase ?? Math.PI / 2) + 0.25;
            this.get("amplitude").value = Math.sin(this.phase);
            this.draw();
        } else {
            const { value, max } = this.get("slider");
            this.#go(Number(value) >= Number(max) ? 0 : Number(value) + 1);
        }
    }

    openStudy(number) {
        if (this.playing) {
            this.play();
        }
        const study = this.data.studies[number];
        this.study = study;
        this.tables = study.tables.map((table) => new Table(this.arrays, table));
        this.own = this.tables.find(({ name }) => name === `${study.name}.csv`);
        const { driven } = Object.fromEntries(study.facts);
        if (this.own && driven in DRIVEN) {
            [this.own.said.drive, this.own.said.reaction] = DRIVEN[driven];
        }
        this.states = study.sheet && this.view ? new States(this.arrays, study.sheet) : null;
        this.meshes = [];
        this.scales.clear();
        this.#verdict();
        this.#figures();
        this.#plots();
        this.#show("sheet", Boolean(this.states));
        this.#stage(Boolean(this.states));
        ["play", "slider", "where"].forEach((id) => {
            this.get(id).hidden = !this.states;
        });
        this.get("note").textContent = this.#missing();
        if (study.figures.length > 0) {
            this.#enlarge(study.figures[0]);
        }
        if (!this.states) {
            ["sequence", "facets", "follow", "amplitude"].forEach((control) => this.#show(control, false));
            this.#describe(null);
            return;
        }
        this.#colours();
        const { sequences, moving, meshes, states } = study.sheet;
        options(this.get("sequence"), sequences.map(({ name }, k) => [String(k), name]), "0");
        this.#show("sequence", sequences.length > 1);
        this.#show("amplitude", moving);
        this.#show("facets", meshes.some(({ kinds }) => this.arrays.indices(kinds).includes(1)));
        this.#show("follow", states.some(({ offset }) => offset.some((x) => Math.abs(x) > 1e-6)));
        // what is driven is held in its place
        this.get("follow").checked = this.own?.columns.has("drive") !== true;
        this.get("amplitude").value = 1;
        this.openSequence(0);
        this.#face();
    }

    /** Turns the sheet to the eye, so far away that all states of the sequence are seen, modes with any amplitude. */
    #face() {
        const { toward, normal, moving } = this.study.sheet;
        const amplitudes = moving ? [-1, 1] : [0];
        this.view.orient(toward, normal, this.sequence.flatMap((state) => amplitudes.map((part) => this.#points(state, part))));
        this.draw();
    }

    #points(state, amplitude = Number(this.get("amplitude").value)) {
        return this.states.points(state, SWING * amplitude, !this.get("follow").checked);
    }

    #show(control, truth) {
        this.root.querySelectorAll(`[data-for="${control}"]`).forEach((part) => {
            part.hidden = !truth;
        });
    }

    /** Why there is no sheet to see. */
    #missing() {
        if (this.study.sheet && !this.view) {
            return "This browser draws nothing in space (it has no WebGL): see the plots and pictures beside.";
        }
        const words = this.study.figures.length ? "" : "This study has no picture: see the plots and results beside.";
        return this.study.sheet ? "" : words;
    }

    #verdict() {
        const { converged, reason, name, kind, others, facts } = this.study;
        const verdict = this.get("verdict");
        verdict.textContent = converged ? `Study ${name}, ${kind}: done.` : `Study ${name}, ${kind}: no answer. ${reason ?? ""}`;
        verdict.classList.toggle("failed", !converged);
        rows(this.get("facts"), facts.map(([key, value]) => [key, short(value)]));
        this.get("facts-box").hidden = facts.length === 0;
        this.get("others").textContent = others.length ? `Further files of this study, for ParaView: ${others.join(", ")}.` : "";
    }

    #figures() {
        this.get("figures").replaceChildren(...this.study.figures.map((figure) => {
            const button = document.createElement("button");
            const image = Object.assign(new Image(), { src: picture(figure.svg), alt: figure.name });
            button.append(figure.name, image);
            button.type = "button";
            button.title = this.states ? "Show in place of the sheet, or the sheet again" : "Show";
            button.addEventListener("click", () => this.#toggle(figure));
            return button;
        }));
    }

    #enlarge(figure) {
        this.get("picture").alt = figure.name;
        this.get("picture").src = picture(figure.svg);
    }

    /** Shows a drawing in place of the sheet, or the sheet again. */
    #toggle(figure) {
        const image = this.get("picture");
        const again = this.states && !image.hidden && image.alt === figure.name;
        this.#enlarge(figure);
        this.#stage(Boolean(again));
    }

    /** Shows the sheet on the stage, or the picture. */
    #stage(sheet) {
        ["canvas", "triad", "legend"].forEach((id) => this.get(id).toggleAttribute("hidden", !sheet));
        this.get("picture").hidden = sheet || this.study.figures.length === 0;
    }

    #plots() {
        this.charts = [];
        const wanted = PLOTS.flatMap(([end, x, y]) => this.tables
            .filter((table) => table.name.endsWith(end) && [x, y].every((name) => table.names().includes(name)))
            .map((table) => [table, x, y]));
        const any = this.tables.filter((table) => table.names().length > 1).map((table) => [table, ...table.names()]);
        const curved = wanted.filter(([table]) => table.rows > 1);
        const same = ([a, ...b], [c, ...d]) => a === c && b.slice(0, 2).join() === d.slice(0, 2).join();
        const all = curved.length ? curved : any.filter(([table]) => table.rows > 1).slice(0, 1);
        const chosen = all.filter((one, k) => all.findIndex((other) => same(one, other)) === k).slice(0, SHOWN);
        this.get("plots").replaceChildren(...chosen.map((choice) => this.#plot(choice)));
    }

    /** A plot with lists of what it shows. */
    #plot([table, x, y]) {
        const chart = new Chart(this.data.palette.series);
        const figure = Object.assign(document.createElement("figure"), { className: "plot" });
        const [tables, across, upwards] = ["Table", "Across", "Upwards"].map((words) => {
            const select = document.createElement("select");
            select.setAttribute("aria-label", words);
            return select;
        });
        const entry = { chart, table };
        const useful = this.tables.filter((one) => one.names().length > 1);
        const fill = (right, up) => {
            const names = entry.table.names().map((name) => [name, entry.table.spoken(name)]);
            options(across, names, right);
            options(upwards, names, up);
        };
        const draw = () => {
            chart.draw(entry.table, [across.value, upwards.value]);
            this.#mark();
        };
        options(tables, useful.map((one, k) => [String(k), one.name]), String(useful.indexOf(table)));
        tables.hidden = useful.length < 2;
        fill(x, y);
        tables.addEventListener("change", () => {
            entry.table = useful[Number(tables.value)];
            const [first, second] = entry.table.names();
            fill(first, second);
            draw();
        });
        [across, upwards].forEach((select) => select.addEventListener("change", draw));
        const caption = document.createElement("figcaption");
        caption.append(upwards, " over ", across, " ", tables);
        figure.append(caption, chart.svg);
        this.charts.push(entry);
        draw();
        return figure;
    }

    #colours() {
        const { fields } = this.states;
        const entries = [[PALE, "mountain and valley"], ...fields.map((name) => [name, spoken(name)])];
        if (fields.includes("fold_angle")) {
            entries.push([CURVATURE, "mean curvature"]);
        }
        const before = this.get("colours").value;
        options(this.get("colours"), entries, entries.some(([name]) => name === before) ? before : PALE);
    }

    openSequence(number) {
        this.sequence = this.study.sheet.sequences[number].states;
        this.get("slider").max = this.sequence.length - 1;
        const last = this.study.kind === "relax" ? this.sequence.length - 1 : 0;
        this.#go(last);
    }

    #mesh(state) {
        const number = this.study.sheet.states[state].mesh;
        this.meshes[number] ??= withSides(this.states.mesh(state));
        return this.meshes[number];
    }

    /** Draws the state at the place of the slider. */
    draw() {
        if (!this.states || !this.sequence) {
            return;
        }
        const place = Number(this.get("slider").value);
        const state = this.sequence[place];
        const mesh = this.#mesh(state);
        const points = this.#points(state);
        const has = this.states.fields.includes("fold_angle");
        const angles = has ? this.states.values(state, "fold_angle") : new Float64Array(mesh.kinds.length).fill(NaN);
        this.view.show(mesh, points, {
            angles,
            sharpest: this.#sharpest(),
            crossing: this.states.crossing(state),
            painted: this.#painted(state, mesh, points, angles),
            facets: this.get("facets").checked,
            rim: getComputedStyle(this.root.documentElement).getPropertyValue("--rim").trim(),
        });
        this.shown = state;
        const { row } = this.study.sheet.states[state];
        const count = `${this.states.sheet.moving ? "mode" : "state"} ${place + 1} of ${this.sequence.length}`;
        this.get("where").textContent = [count, ...this.#numbers(row)].join(", ");
        this.#describe(row);
        this.#legend(state);
    }

    /** How far the drive is, and energy and reaction of a row, where the study has them. */
    #numbers(row) {
        const value = (name) => this.own?.clean(name, row);
        if (this.study.kind === "fold") {
            return [`folded ${short(100 * value("drive"))} %`, `energy ${short(value("energy_total"))}`];
        }
        const entries = [["drive", "drive"], ["energy", "energy_total"], [this.own?.spoken("reaction"), "reaction"]];
        const known = entries.filter(([, name]) => Number.isFinite(value(name)));
        return known.map(([words, name]) => `${words} ${short(value(name))}`);
    }

    #sharpest() {
        const { low, high } = this.study.sheet.fields.find(({ name }) => name === "fold_angle") ?? { low: 0, high: 0 };
        return Math.min(Math.max(-low, high, 1e-300), Math.PI);
    }

    /** The colours of a state; null for mountains and valleys. */
    #painted(state, mesh, points, angles) {
        const name = this.get("colours").value;
        if (name === PALE) {
            this.scale = null;
            return null;
        }
        this.scale = this.#scale(name);
        return name === CURVATURE
            ? paintedByFaces(this.#curvature(state), this.scale)
            : paintedByLines(mesh, this.states.values(state, name), this.scale, name);
    }

    /** Mean curvatures of the faces of a state, in the unit of the scene. */
    #curvature(state) {
        const points = this.states.points(state, 0);
        const found = meanCurvature(this.#mesh(state), points, this.states.values(state, "fold_angle"));
        return found.map((value) => value / this.study.sheet.size);
    }

    /** The scale of a quantity, the same for all states of the study. */
    #scale(name) {
        if (!this.scales.has(name)) {
            const { palette } = this.data;
            const field = this.study.sheet.fields.find((one) => one.name === name);
            const all = name === CURVATURE ? this.study.sheet.states.map((_, state) => this.#curvature(state)) : [];
            const finite = all.map((values) => values.filter(Number.isFinite));
            const ends = finite.reduce(([a, b], values) => values.reduce(([c, d], x) => [Math.min(c, x), Math.max(d, x)], [a, b]), [0, 0]);
            const [low, high] = field ? [field.low, field.high] : ends;
            const stretched = STRETCHED.includes(name);
            const signed = stretched ? [...palette.signed].reverse() : palette.signed;
            this.scales.set(name, new Scale(palette, low, high, name === CURVATURE ? palette.curvature : signed, stretched));
        }
        return this.scales.get(name);
    }

    #legend(state) {
        const legend = this.get("legend");
        const { palette } = this.data;
        const entry = (colour, words) => {
            const part = document.createElement("span");
            const line = Object.assign(document.createElement("span"), { className: "line" });
            line.style.background = colour;
            part.append(line, words);
            return part;
        };
        const words = (text) => Object.assign(document.createElement("span"), { textContent: text });
        const found = [];
        if (this.scale) {
            const bar = Object.assign(document.createElement("span"), { className: "bar" });
            bar.style.background = `linear-gradient(to right, ${this.scale.ramp.join(", ")})`;
            const name = this.get("colours").value;
            const [low, high] = STRETCHED.includes(name) ? ["compression ", " tension"] : ["", ""];
            const ends = [low + short(this.scale.low), short(this.scale.high) + high];
            found.push(words(spoken(name).replace("-", " ")), words(ends[0]), bar, words(ends[1]));
        } else {
            const { low, high } = this.study.sheet.fields.find(({ name }) => name === "fold_angle") ?? { low: 0, high: 0 };
            const { kinds, letters } = this.#mesh(state);
            const side = (colour, name, letter, angle) => {
                const lettered = letters.some((one, line) => kinds[line] === 0 && LETTERS[one] === letter);
                const folds = Math.abs(angle) > 1e-6;
                return folds || lettered ? [entry(colour, folds ? `${name}, to ${short(angle)} rad${turns(angle)}` : `${name} (${letter})`)] : [];
            };
            found.push(...side(palette.mountain, "mountain", "M", Math.min(low, 0)), ...side(palette.valley, "valley", "V", Math.max(high, 0)));
        }
        if (this.states.crossing(state)) {
            found.push(entry(palette.crossing, "passes through other faces"));
        }
        legend.replaceChildren(...found);
    }

    /** Moves the dots of the plots to the row of the state, and lists what the row says. */
    #describe(row) {
        this.row = row;
        this.#mark();
        const table = this.own;
        const known = row !== null && row !== undefined && table && row < table.rows;
        rows(this.get("state"), known ? table.row(row) : []);
        this.get("state-box").hidden = !known;
    }

    #mark() {
        const own = (table) => table === this.own && this.row < table.rows;
        this.charts.forEach(({ chart, table }) => chart.mark(own(table) ? (this.row ?? null) : null));
    }

    /** Says the number and the values of the edge under the pointer. */
    #tell({ offsetX, offsetY, buttons }) {
        if (!this.states || buttons) {
            return;
        }
        const line = this.view.lineAt(offsetX, offsetY);
        if (line === null) {
            this.get("note").textContent = "";
            return;
        }
        const mesh = this.#mesh(this.shown);
        const values = this.states.fields.map((name) => [name, this.states.values(this.shown, name)[line]]);
        const known = values.filter(([, value]) => Number.isFinite(value));
        const kind = ["crease", "facet", "boundary"][mesh.kinds[line]];
        const said = ([name, value]) => `${spoken(name)} ${short(value)}${name === "fold_angle" ? turns(value) : ""}`;
        const letter = LETTERS[mesh.letters[line]];
        this.get("note").textContent = [`edge ${mesh.edges[line]} (${kind}, ${letter})`, ...known.map(said)].join("\n");
    }
}

/** Opens the page on the data that it holds. */
export function start(root) {
    return new Page(root, JSON.parse(root.getElementById("data").textContent));
}
