// Opens pages in a headless browser without a network, and uses them as a reader would.
//
//     node .ci/check_view.mjs NODE_MODULES CHROMIUM PICTURES PAGE.html...
//
// NODE_MODULES is a folder with the package playwright-core, CHROMIUM the program. For every study on every page: no
// error is reported and nothing is asked from a network; the sheet is there, where the study has states, and differs
// from the background; every point of every state is inside the window, on a desk and on a telephone, held upright or
// not; arrow keys move the slider; moving it from one end to the other changes the picture of the sheet,
// unless all its states are the same, and moves the dot of the first plot, if the plot has one; colours change the
// picture; a study without states shows a drawing or says that there is none. A screenshot of each study is written into
// PICTURES, to be looked at. The exit status is 1 where a check fails.
import { mkdirSync } from "node:fs";
import { createRequire } from "node:module";
import { basename, dirname, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [folder, program, pictures, ...pages] = process.argv.slice(2);
const { chromium } = createRequire(resolve(folder, "package.json"))("playwright-core");
let [passed, failed] = [0, 0];

function that(truth, claim) {
    if (truth) {
        passed += 1;
    } else {
        failed += 1;
        console.log(`FAILED ${claim}`);
    }
}

/** Sizes of windows: a desk, a telephone held upright, and the same one turned. */
const DESK = { width: 1280, height: 800 };
const PHONES = [{ width: 390, height: 844 }, { width: 844, height: 390 }];

/** Number of different colours in a part of the page, counted in the browser, and the bytes of its picture. */
async function seen(page, selector) {
    const shot = await page.locator(selector).screenshot();
    const colours = await page.evaluate(async (address) => {
        const image = new Image();
        image.src = address;
        await image.decode();
        const canvas = Object.assign(document.createElement("canvas"), { width: image.width, height: image.height });
        const context = canvas.getContext("2d");
        context.drawImage(image, 0, 0);
        const pixels = new Uint32Array(context.getImageData(0, 0, image.width, image.height).data.buffer);
        const background = pixels[0];
        return { count: new Set(pixels).size, part: pixels.filter((pixel) => pixel !== background).length / pixels.length };
    }, `data:image/png;base64,${shot.toString("base64")}`);
    return { ...colours, bytes: shot.toString("base64") };
}

/** Waits until what was asked for is drawn. */
async function drawn(page) {
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}

/** Pixels by which the point of any state that is farthest out lies outside the canvas, and the canvas outside the window;
 *  negative where all are inside. */
async function outside(page) {
    return page.evaluate(() => {
        const { view, get, states } = window.foldwell;
        const [slider, amplitude, along] = ["slider", "amplitude", "sequence"].map((id) => get(id));
        const { left, top, right, bottom, width, height } = get("canvas").getBoundingClientRect();
        let farthest = Math.max(-left, -top, right - window.innerWidth, bottom - window.innerHeight);
        for (let sequence = 0; sequence < along.options.length; sequence += 1) {
            along.value = sequence;
            along.dispatchEvent(new Event("change"));
            for (let state = 0; state <= Number(slider.max); state += 1) {
                for (const part of states.sheet.moving ? [-1, 1] : [1]) {
                    [slider.value, amplitude.value] = [state, part];
                    window.foldwell.draw();
                    const known = view.places().filter((place) => place.every(Number.isFinite));
                    known.forEach(([x, y]) => {
                        farthest = Math.max(farthest, -x, -y, x - width, y - height);
                    });
                }
            }
        }
        return farthest;
    });
}

async function checkInside(page, where) {
    const far = await outside(page);
    const { width, height } = page.viewportSize();
    that(far <= 0, `${where}: the sheet is inside the window of ${width} x ${height} in every state (${far} pixels)`);
}

async function dot(page) {
    const found = page.locator(".plot .dot").first();
    if (await found.count() === 0 || await found.getAttribute("visibility") === "hidden") {
        return null;
    }
    return `${await found.getAttribute("cx")} ${await found.getAttribute("cy")}`;
}

async function checkSheet(page, where) {
    const first = await seen(page, "#canvas");
    that(first.count > 8 && first.part > 0.01, `${where}: the sheet is there (${first.count} colours on ${first.part})`);
    const states = Number(await page.locator("#slider").getAttribute("max")) + 1;
    const moving = await page.locator("#amplitude").isVisible();
    await page.keyboard.press("Home");
    await drawn(page);
    const [begin, here] = [await seen(page, "#canvas"), await dot(page)];
    if (states > 1) {
        await page.keyboard.press("ArrowRight");
        that(await page.locator("#slider").inputValue() === "1", `${where}: an arrow moves the slider by one`);
        // half way, since a closed trajectory ends where it begins
        await page.locator("#slider").evaluate((slider, place) => {
            slider.value = place;
            slider.dispatchEvent(new Event("input"));
        }, Math.ceil((states - 1) / 2));
        await drawn(page);
        const middle = await seen(page, "#canvas");
        that(middle.bytes !== begin.bytes, `${where}: the slider changes the picture`);
        that(here === null || here !== await dot(page), `${where}: the slider moves the dot`);
        that((await page.locator("#where").textContent()).includes(`of ${states}`), `${where}: the place is said`);
    }
    if (moving) {
        await page.locator("#amplitude").fill("-1");
        await drawn(page);
        that((await seen(page, "#canvas")).bytes !== begin.bytes, `${where}: the amplitude changes the picture`);
    }
    await checkColours(page, where);
    await page.locator("#canvas").hover({ position: { x: 300, y: 300 } });
    await page.mouse.down();
    await page.mouse.move(520, 420, { steps: 4 });
    await page.mouse.up();
    await drawn(page);
    const turned = await seen(page, "#canvas");
    await page.locator("#reset").click();
    await drawn(page);
    that(turned.bytes !== (await seen(page, "#canvas")).bytes, `${where}: the mouse turns the sheet, and Reset view turns it back`);
    const control = moving ? "#amplitude" : "#slider";
    const before = await page.locator(control).inputValue();
    if (states > 1 || moving) {
        await page.locator("#play").click();
        const plays = page.waitForFunction(([name, value]) => document.querySelector(name).value !== value, [control, before],
            { timeout: 10_000 });
        that(await plays.then(() => true, () => false), `${where}: it plays`);
        await page.locator("#play").click();
    }
}

async function checkColours(page, where) {
    const names = await page.locator("#colours option").evaluateAll((options) => options.map((option) => option.value));
    that(names.includes("fold_angle") && names.includes("mean-curvature"), `${where}: colours of ${names}`);
    const plain = await seen(page, "#canvas");
    for (const name of names.slice(1)) {
        await page.locator("#colours").selectOption(name);
        await drawn(page);
        const legend = await page.locator("#legend").textContent();
        that(plain.bytes !== (await seen(page, "#canvas")).bytes && /\d/.test(legend), `${where}: colours by ${name}`);
        that(!/NaN|undefined|Infinity/.test(legend), `${where}: the legend of ${name}: ${legend}`);
    }
    await page.locator("#colours").selectOption(names[0]);
    await drawn(page);
}

async function checkStudy(page, where) {
    const text = await page.locator("body").innerText();
    that(!/NaN|undefined|\[object/.test(text), `${where}: no value is NaN or undefined`);
    const broken = await page.locator(".plot [d*=NaN], .plot [cx*=NaN]").count();
    that(broken === 0, `${where}: plots have numbers only`);
    if (await page.locator("#canvas").isVisible()) {
        await checkSheet(page, where);
    } else {
        const wide = await page.locator("#picture").evaluate((image) => !image.hidden && image.naturalWidth > 0);
        that(wide || (await page.locator("#note").textContent()).length > 0, `${where}: a drawing, or a word why there is none`);
    }
}

async function checkPage(browser, file) {
    const context = await browser.newContext({ viewport: DESK, offline: true });
    const page = await context.newPage();
    page.setDefaultTimeout(120_000); // pictures are drawn without a graphics card
    const [errors, asked] = [[], []];
    page.on("console", (message) => ["error", "warning"].includes(message.type()) && errors.push(message.text()));
    page.on("pageerror", (error) => errors.push(String(error)));
    page.on("request", (request) => /^(https?|wss?|ftp):/.test(request.url()) && asked.push(request.url()));
    await page.goto(pathToFileURL(resolve(file)).href);
    await drawn(page);
    const studies = await page.locator("#study option").count();
    that(studies > 0, `${file}: there are studies`);
    that(await page.locator("#title").innerText() === await page.title() && await page.title() !== "", `${file}: a title`);
    for (let k = 0; k < studies; k += 1) {
        await page.locator("#study").evaluate((select, value) => {
            select.value = value;
            select.dispatchEvent(new Event("change"));
        }, String(k));
        await drawn(page);
        const name = await page.locator("#study option").nth(k).textContent();
        const shot = `${basename(dirname(resolve(file)))}-${name.replace(/\W+/g, "-")}`;
        await page.screenshot({ path: resolve(pictures, `${shot}.png`) });
        const where = `${file}, study ${name}`;
        if (await page.locator("#canvas").isVisible()) {
            await checkInside(page, where);
            for (const size of PHONES) {
                await page.setViewportSize(size);
                await drawn(page);
                await page.screenshot({ path: resolve(pictures, `${shot}-${size.width}.png`) });
                await checkInside(page, where);
            }
            await page.setViewportSize(DESK);
            await drawn(page);
        }
        await checkStudy(page, where);
    }
    await page.locator("#theme").click();
    await drawn(page);
    await page.screenshot({ path: resolve(pictures, `${basename(dirname(resolve(file)))}-other-background.png`) });
    that(errors.length === 0, `${file}: no error in the console: ${errors.slice(0, 3)}`);
    that(asked.length === 0, `${file}: nothing is asked from a network: ${asked.slice(0, 3)}`);
    await context.close();
}

mkdirSync(pictures, { recursive: true });
// a machine without a graphics card draws with the processor
const args = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"];
const browser = await chromium.launch({ executablePath: program, args });
for (const file of pages) {
    await checkPage(browser, file);
}
await browser.close();
console.log(`${passed} checks of ${pages.length} pages passed, ${failed} failed`);
process.exitCode = failed > 0 ? 1 : 0;
