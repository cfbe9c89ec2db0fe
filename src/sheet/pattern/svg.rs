//! SVG drawings with the colours of Origami Simulator.
//!
//! Shapes with a stroke are lines of the pattern: `line`, `polyline`, `polygon`, `rect`, `circle`, `ellipse` and
//! `path`, in groups and clones (`use`), with their transforms; curves become polylines. Lengths are those of the
//! drawing's own coordinates: the size of the page does not count. What has no stroke, no width, or is not
//! displayed, is ignored, and so are texts, images and elements of other programs.

use kurbo::Affine;
use roxmltree::{Document, Node};
use svgtypes::{Paint, Transform, ViewBox};

use super::colour;
use super::line::{DrawnLines, Lines, Misread, PatternLine, flip};
use super::outline::{self, Outline};
use super::svg_shape::{Units, outline};
use super::svg_style::{Properties, Rules, SvgStyle};
use super::xml;
use crate::math::Vec2;
use crate::sheet::assignment::Assignment;
use crate::sheet::pattern_fault::PatternFault;

/// Most elements in each other, clones included.
const DEEPEST: usize = 200;

/// Most elements, clones included; clones of clones can be many in a short file.
const MOST_ELEMENTS: usize = 1_000_000;

/// Reads the lines of a text.
pub(super) fn lines(text: &str) -> Lines {
    let document = xml::document(text, "an SVG file")?;
    let root = document.root_element();
    if root.tag_name().name() != "svg" {
        let fault = PatternFault::value(root.tag_name().name(), "outermost element of an SVG file", "`svg`");
        return Err((xml::place(&document, root), fault.into()));
    }
    let title = root.children().find(|node| node.tag_name().name() == "title").and_then(|node| node.text());
    let mut drawing =
        SvgDrawing { document: &document, rules: Rules::new(&document)?, elements: 0, grey: 0, outlines: vec![] };
    drawing.read(root, &Around::root(root), 0)?;
    let mut drawn = DrawnLines { title: title.unwrap_or_default().trim().to_owned(), ..DrawnLines::default() };
    drawn.redrawing.grey = drawing.grey;
    outline::draw(&drawing.outlines, &mut drawn);
    if drawn.lines.is_empty() {
        return Err(([1, 1], PatternFault::Empty { right: "draw shapes with a coloured stroke" }.into()));
    }
    Ok(drawn)
}

/// Properties that an element inherits from the elements around it.
#[derive(Clone, Copy)]
struct Around {
    style: SvgStyle,
    transform: Affine,
    units: Units,
    /// Width and height that a clone gives to its original; no numbers where it gives none.
    room: [f64; 2],
}

struct SvgDrawing<'d, 'input> {
    document: &'d Document<'input>,
    rules: Rules<'d>,
    elements: usize,
    /// Number of grey shapes.
    grey: usize,
    outlines: Vec<Outline>,
}

impl<'d, 'input> SvgDrawing<'d, 'input> {
    /// Reads an element and those in it.
    fn read(&mut self, node: Node<'d, 'input>, around: &Around, depth: usize) -> Result<(), Misread> {
        let document = self.document;
        let located = |fault: PatternFault| (xml::place(document, node), Box::from(fault));
        self.elements += 1;
        if depth > DEEPEST || self.elements > MOST_ELEMENTS {
            let right = "there should be at most 1,000,000 of them, clones included, and at most 200 in each other";
            return Err(located(PatternFault::Element { element: "too many elements".into(), right }));
        }
        let mut properties = self.rules.properties(node);
        if let Some(colour) = properties.get("stroke").and_then(|paint| self.swatch(paint)) {
            properties.insert("stroke", colour);
        }
        let mut here = around.with(&properties).map_err(located)?;
        here.room = UNKNOWN;
        let is_foreign = node.tag_name().namespace() != document.root_element().tag_name().namespace();
        if is_foreign || !here.style.displayed {
            return Ok(());
        }
        match node.tag_name().name() {
            // without languages or features of its own the first child that asks for no extension applies
            "switch" => node
                .children()
                .find(|child| child.is_element() && !child.has_attribute("requiredExtensions"))
                .map_or(Ok(()), |child| self.read(child, &here, depth + 1)),
            name @ ("svg" | "g" | "a" | "symbol") => {
                if depth > 0 && matches!(name, "svg" | "symbol") {
                    here.frame(node, around.room).map_err(located)?;
                }
                // symbols are drawn where they are used
                let drawn = node.children().filter(|child| child.is_element() && child.tag_name().name() != "symbol");
                drawn.into_iter().try_for_each(|child| self.read(child, &here, depth + 1))
            }
            "use" => {
                here.shift(node).map_err(located)?;
                here.room = here.size(node, UNKNOWN).map_err(located)?;
                let original = self.original(node).map_err(located)?;
                self.read(original, &here, depth + 1)
            }
            _ => self.shape(node, &here).map_err(located),
        }
    }

    /// Returns the element of which another one is a clone.
    fn original(&self, node: Node<'d, 'input>) -> Result<Node<'d, 'input>, PatternFault> {
        let named = node.attributes().find(|attribute| attribute.name() == "href").map(|name| name.value());
        let id = named.and_then(|name| name.strip_prefix('#'));
        let found = id.and_then(|id| self.document.descendants().find(|other| other.attribute("id") == Some(id)));
        found.ok_or_else(|| {
            PatternFault::value(named.unwrap_or_default(), "element of this file", "`#` and the `id` of an element")
        })
    }

    /// Returns the colour of a gradient whose stops have one, as programs write swatches; `None` for another paint.
    fn swatch(&self, paint: &str) -> Option<&'d str> {
        let Ok(Paint::FuncIRI(id, _)) = Paint::from_str(paint) else { return None };
        let gradient = self.document.descendants().find(|node| node.attribute("id") == Some(id))?;
        let linked = std::iter::successors(Some(gradient), |node| self.original(*node).ok()).take(DEEPEST);
        let stops = |node: Node<'d, 'input>| node.children().filter(|child| child.tag_name().name() == "stop");
        let stops: Vec<Properties> = linked.map(stops).find_map(|stops| {
            let own: Vec<Properties> = stops.map(|stop| self.rules.properties(stop)).collect();
            (!own.is_empty()).then_some(own)
        })?;
        let colour = |own: &Properties<'d>| own.get("stop-color").copied().unwrap_or("black");
        let is_opaque = |own: &Properties| own.get("stop-opacity").is_none_or(|opacity| opacity.parse() == Ok(1.0));
        let first = colour(&stops[0]);
        let one = stops.iter().all(|own| colour(own) == first && is_opaque(own));
        one.then_some(first)
    }

    fn shape(&mut self, node: Node, here: &Around) -> Result<(), PatternFault> {
        let is_seen = |(_, alpha): &(_, f64)| here.style.visible && here.style.wide && *alpha > 0.0;
        let Some((colour, alpha)) = here.style.stroke.filter(is_seen) else { return Ok(()) };
        let Some(outline) = outline(node, &here.units)? else { return Ok(()) };
        let rgb = [colour.red, colour.green, colour.blue];
        let [red, green, blue] = rgb;
        let name = || format!("#{red:02x}{green:02x}{blue:02x}");
        let wrong = || PatternFault::value(&name(), "colour of a line", colour::RIGHT);
        let auxiliary = colour::is_grey(rgb);
        self.grey += usize::from(auxiliary);
        let letter = colour::letter(rgb).or(auxiliary.then_some(Assignment::Flat)).ok_or_else(wrong)?;
        let angle = angle(letter, here.style.opacity * here.style.stroke_opacity * alpha);
        let ends = [Vec2::zeros(); 2];
        let line =
            PatternLine { ends, letter, angle, auxiliary, contour: false, at: node.range().start, flipped: true };
        self.outlines.push(Outline { path: here.placed() * outline, line, named: false });
        Ok(())
    }
}

/// Whether a list of lengths is that of the origin.
fn is_origin(text: &str) -> bool {
    text.split_whitespace().all(|length| ["0", "0px", "0%"].contains(&length))
}

/// Returns the target angle in degrees of a line of this opacity.
fn angle(letter: Assignment, opacity: f64) -> Option<f64> {
    let folded = opacity * 180.0;
    match letter {
        Assignment::Mountain => Some(flip(folded)),
        Assignment::Valley => Some(folded),
        Assignment::Flat => Some(0.0),
        _ => None,
    }
}

/// The width and height of what has none.
const UNKNOWN: [f64; 2] = [f64::NAN; 2];

impl Around {
    /// Returns what is around the outermost element; letters are as large as browsers draw them.
    fn root(node: Node) -> Self {
        let units = Units { viewport: UNKNOWN, em: 16.0 };
        let mut root = Self { style: SvgStyle::default(), transform: Affine::IDENTITY, units, room: UNKNOWN };
        let view: Option<ViewBox> = node.attribute("viewBox").and_then(|text| text.parse().ok());
        root.units.viewport = view.map_or_else(|| root.size(node, UNKNOWN).unwrap_or(UNKNOWN), |view| [view.w, view.h]);
        root
    }

    /// Returns width and height of an element, or those that it has otherwise.
    fn size(&self, node: Node, mut otherwise: [f64; 2]) -> Result<[f64; 2], PatternFault> {
        for (size, name) in otherwise.iter_mut().zip(["width", "height"]) {
            if node.attribute(name).is_some_and(|text| text != "auto") {
                *size = self.units.length(node, name)?;
            }
        }
        Ok(otherwise)
    }

    /// Moves into the viewport of an element in others, which fits its `viewBox` into its size.
    fn frame(&mut self, node: Node, room: [f64; 2]) -> Result<(), PatternFault> {
        self.shift(node)?;
        let own = self.size(node, self.units.viewport)?;
        let size = [0, 1].map(|k| if room[k].is_nan() { own[k] } else { room[k] });
        self.units.viewport = size;
        let Some(text) = node.attribute("viewBox") else { return Ok(()) };
        let right = "`x y width height` in an element whose size is known";
        let view: Option<ViewBox> = text.parse().ok().filter(|_| size.iter().all(|size| size.is_finite()));
        let view = view.ok_or_else(|| PatternFault::value(text, "`viewBox` that is read", right))?;
        let aspect = node.attribute("preserveAspectRatio").unwrap_or_default();
        let [x, y] = [size[0] / view.w, size[1] / view.h];
        let [x, y] = match aspect {
            _ if aspect.contains("none") => [x, y],
            _ if aspect.contains("slice") => [x.max(y); 2],
            _ => [x.min(y); 2],
        };
        let part = |low, high| match [low, high].map(|word| aspect.contains(word)) {
            [true, _] => 0.0,
            [_, true] => 1.0,
            _ => 0.5,
        };
        let rest = [(size[0] - x * view.w) * part("xMin", "xMax"), (size[1] - y * view.h) * part("YMin", "YMax")];
        self.transform *= Affine::new([x, 0.0, 0.0, y, rest[0] - x * view.x, rest[1] - y * view.y]);
        self.units.viewport = [view.w, view.h];
        Ok(())
    }

    /// Returns what an element with these properties says to those in it.
    fn with(&self, properties: &Properties) -> Result<Self, PatternFault> {
        let (style, mut units) = (self.style.of(properties)?, self.units);
        if let Some(size) = properties.get("font-size").filter(|size| **size != "inherit") {
            units.em = units.number(size, units.em).unwrap_or(f64::NAN);
        }
        let Some(text) = properties.get("transform").filter(|text| **text != "none") else {
            return Ok(Self { style, units, ..*self });
        };
        if let Some(origin) = properties.get("transform-origin").filter(|origin| !is_origin(origin)) {
            let right = "`0 0`, and the shift a part of `transform`";
            return Err(PatternFault::value(origin, "origin of a transform that is read", right));
        }
        let wrong = |_| PatternFault::value(text, "transform", "`translate(1 2)`, `matrix(1 0 0 1 0 0)` or the like");
        let Transform { a, b, c, d, e, f } = text.parse().map_err(wrong)?;
        let transform = self.transform * Affine::new([a, b, c, d, e, f]);
        Ok(Self { style, units, transform, ..*self })
    }

    /// Translates by the attributes `x` and `y` of an element.
    fn shift(&mut self, node: Node) -> Result<(), PatternFault> {
        self.transform *= Affine::translate((self.units.length(node, "x")?, self.units.length(node, "y")?));
        Ok(())
    }

    /// Returns the transform from an element to the sheet, whose y points upwards.
    fn placed(&self) -> Affine {
        let [a, b, c, d, e, f] = self.transform.as_coeffs();
        Affine::new([a, flip(b), c, flip(d), e, flip(f)])
    }
}
