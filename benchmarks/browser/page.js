// What is done to a drawing inside the browser; `svg` is its root element, `view` its window.

const shapes = ["path", "rect", "circle", "ellipse", "line", "polyline", "polygon"];
const containers = "defs, symbol, pattern, marker, mask, clipPath, linearGradient, radialGradient, filter";
const svgSpace = "http://www.w3.org/2000/svg";
const styleOf = (element) => view.getComputedStyle(element);
const reference = (value) => (/^url\(["']?[^#"')]*#([^"')]*)/.exec(value) || [])[1];
const byId = (id) => (id === undefined ? null : svg.ownerDocument.getElementById(decodeURIComponent(id)));
const isCut = (element) => {
    const style = styleOf(element);
    return style.clipPath !== "none" || style.maskImage !== "none" || style.opacity !== "1";
};

function facts() {
    const all = [...svg.querySelectorAll("*"), svg];
    const box = svg.getBoundingClientRect();
    const isAbsolute = (side) => {
        const unit = svg.hasAttribute(side) && svg[side] ? svg[side].baseVal.unitType : 2;
        return unit !== 2;
    };
    const patterns = all.filter((element) => shapes.includes(element.localName) && patternOf(element) !== null);
    return {
        error: svg.localName !== "svg" || svg.querySelector("parsererror") !== null || svg.namespaceURI !== svgSpace,
        size: [box.width, box.height],
        absolute: [isAbsolute("width"), isAbsolute("height")],
        text: svg.querySelector("text") !== null,
        dashed: all.some((element) => styleOf(element).strokeDasharray !== "none"),
        cut: all.some((element) => element !== svg && isCut(element)),
        filtered: all.some((element) => styleOf(element).filter !== "none"),
        patterns: patterns.length,
    };
}

function sheet(rules) {
    const made = new view.CSSStyleSheet();
    made.replaceSync(rules);
    svg.ownerDocument.adoptedStyleSheets = [made];
}

function resize(size) {
    svg.style.setProperty("width", size[0] + "px", "important");
    svg.style.setProperty("height", size[1] + "px", "important");
}

// Hide what nothing cuts, so that what is seen is what is left of the rest.
function hideUncut() {
    for (const element of svg.querySelectorAll("*")) {
        if (element.closest(containers) || !(element.getBBox || element.localName === "foreignObject")) continue;
        let isKept = false;
        for (let at = element; at && at !== svg; at = at.parentElement) isKept = isKept || isCut(at);
        if (!isKept && !element.querySelector("*")) element.style.setProperty("visibility", "hidden", "important");
        if (!isKept && element.localName === "use") element.style.setProperty("visibility", "hidden", "important");
    }
}

function patternOf(element) {
    const found = byId(reference(styleOf(element).fill));
    return found !== null && found.localName === "pattern" ? found : null;
}

function chain(pattern) {
    const links = [];
    for (let at = pattern; at && at.localName === "pattern" && !links.includes(at); ) {
        links.push(at);
        const href = at.getAttribute("href") ?? at.getAttributeNS("http://www.w3.org/1999/xlink", "href");
        at = href && href.startsWith("#") ? byId(href.slice(1)) : null;
    }
    return links;
}

const inherited = ("clip-rule color fill fill-opacity fill-rule marker-end marker-mid marker-start stroke stroke-dasharray"
    + " stroke-dashoffset stroke-linecap stroke-linejoin stroke-miterlimit stroke-opacity stroke-width visibility"
    + " paint-order").split(" ");

function made(name, attributes = {}) {
    const element = svg.ownerDocument.createElementNS(svgSpace, name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    return element;
}

// Write out each `use` that shows a pattern fill, so that its tiles can be.
function expandUses() {
    for (const use of [...svg.querySelectorAll("use")]) {
        const href = use.getAttribute("href") ?? use.getAttributeNS("http://www.w3.org/1999/xlink", "href");
        const target = href && href.startsWith("#") ? byId(href.slice(1)) : null;
        if (use.closest(containers) || target === null || ["svg", "symbol", "use"].includes(target.localName)) continue;
        const group = made("g");
        for (const { name, value } of use.attributes)
            if (!["href", "xlink:href", "x", "y", "width", "height", "id"].includes(name)) group.setAttribute(name, value);
        const moved = made("g", { transform: `translate(${use.x.baseVal.value} ${use.y.baseVal.value})` });
        group.append(moved);
        moved.append(target.cloneNode(true));
        use.replaceWith(group);
    }
}

// Write out the tiles of pattern fills as elements, clipped to the shape. How many could be, how many not.
function expandPatterns() {
    expandUses();
    let done = 0, left = 0;
    for (let round = 0; round < 3; ++round) {
        const todo = [...svg.querySelectorAll(shapes.join(","))].filter((element) =>
            !element.closest(containers) && patternOf(element) !== null);
        for (const element of todo) expand(element) ? ++done : ++left;
    }
    const rest = [...svg.querySelectorAll(shapes.join(","))].filter((element) => patternOf(element) !== null);
    return [done, left + rest.filter((element) => !element.closest("pattern")).length];
}

function expand(element) {
    const links = chain(patternOf(element));
    const value = (name) => links.map((link) => link.getAttribute(name)).find((found) => found !== null);
    const source = links.find((link) => link.children.length > 0);
    const box = element.getBBox();
    const isBox = value("patternUnits") !== "userSpaceOnUse";
    const inUser = (name, axis) => {
        const link = links.find((one) => one.hasAttribute(name));
        if (!link) return 0;
        const length = link[name].baseVal;
        if (!isBox) return length.value;
        return (length.unitType === 2 ? length.valueInSpecifiedUnits / 100 : length.valueInSpecifiedUnits)
            * box[axis];
    };
    const tile = { x: inUser("x", "width"), y: inUser("y", "height"),
                   width: inUser("width", "width"), height: inUser("height", "height") };
    if (isBox) { tile.x += box.x; tile.y += box.y; }
    const hide = () => element.style.setProperty("fill", "none", "important");
    if (!source || !(tile.width > 0) || !(tile.height > 0) || !(box.width > 0) || !(box.height > 0)) { hide(); return true; }
    const clip = made("clipPath", { id: "expanded-" + Math.random().toString(36).slice(2) });
    const outline = element.cloneNode(false);
    const own = styleOf(element);
    for (const name of ["id", "class", "style", "clip-path", "mask", "filter", "transform", "opacity"])
        outline.removeAttribute(name);
    outline.setAttribute("style", `all: unset; d: ${own.d}; x: ${own.x}; y: ${own.y}; width: ${own.width};`
        + ` height: ${own.height}; r: ${own.r}; cx: ${own.cx}; cy: ${own.cy}; rx: ${own.rx}; ry: ${own.ry};`
        + ` clip-rule: ${own.fillRule}`);
    clip.append(outline);
    const matrix = element.transform.baseVal.consolidate();
    const placed = made("g", matrix ? { transform: text(matrix.matrix) } : {});
    if (own.transform !== "none" && !element.hasAttribute("transform")) return false;
    for (const name of ["clip-path", "mask", "filter", "opacity"])
        if (element.hasAttribute(name)) placed.setAttribute(name, element.getAttribute(name));
    const cut = made("g", { "clip-path": `url(#${clip.id})` });
    placed.append(clip, cut);
    const link = links.find((one) => one.transform && one.hasAttribute("patternTransform")
        || styleOf(one).transform !== "none");
    let turned = svg.createSVGMatrix();
    if (link) {
        const list = link.patternTransform.baseVal.consolidate();
        const css = styleOf(link).transform;
        if (list) turned = list.matrix;
        else if (css !== "none") turned = svg.createSVGTransformFromMatrix(new view.DOMMatrix(css)).matrix;
        const [x, y] = styleOf(link).transformOrigin.split(" ").map(parseFloat);
        turned = svg.createSVGMatrix().translate(x, y).multiply(turned).translate(-x, -y);
    }
    const style = styleOf(source);
    const kept = inherited.map((name) => `${name}: ${style.getPropertyValue(name)}`).join("; ");
    const tiles = made("g", { transform: text(turned), style: kept });
    cut.append(tiles);
    let back;
    try { back = turned.inverse(); } catch { hide(); return true; }
    const corners = [[0, 0], [1, 0], [0, 1], [1, 1]].map(([i, j]) => {
        const point = svg.createSVGPoint();
        point.x = box.x + i * box.width; point.y = box.y + j * box.height;
        return point.matrixTransform(back);
    });
    const range = (axis, size) => {
        const at = corners.map((corner) => (corner[axis] - tile[axis]) / tile[size]);
        return [Math.floor(Math.min(...at)), Math.ceil(Math.max(...at))];
    };
    const [left, right] = range("x", "width"), [top, bottom] = range("y", "height");
    if ((right - left) * (bottom - top) > 4000) return false;
    const viewBox = links.find((one) => one.hasAttribute("viewBox"));
    const isBoxContent = !viewBox && value("patternContentUnits") === "objectBoundingBox";
    for (let j = top; j < bottom; ++j) for (let i = left; i < right; ++i) {
        const cell = made("svg", { x: tile.x + i * tile.width, y: tile.y + j * tile.height,
                                   width: tile.width, height: tile.height });
        cell.style.setProperty("overflow", "hidden", "important");
        if (viewBox) {
            cell.setAttribute("viewBox", viewBox.getAttribute("viewBox"));
            const ratio = value("preserveAspectRatio");
            if (ratio) cell.setAttribute("preserveAspectRatio", ratio);
        }
        const content = made("g", isBoxContent ? { transform: `scale(${box.width} ${box.height})` } : {});
        for (const child of source.children) content.append(child.cloneNode(true));
        for (const inner of content.querySelectorAll("[id]")) inner.removeAttribute("id");
        cell.append(content);
        tiles.append(cell);
    }
    element.before(placed);
    hide();
    return true;
}

function text(matrix) {
    return `matrix(${matrix.a} ${matrix.b} ${matrix.c} ${matrix.d} ${matrix.e} ${matrix.f})`;
}
