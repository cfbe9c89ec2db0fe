//! SVG drawings with the colours of Origami Simulator.
//!
//! Shapes with a stroke are lines of the pattern: `line`, `polyline`, `polygon`, `rect`, `circle`, `ellipse` and
//! `path`, in groups and clones (`use`), with their transforms; curves become polylines. Lengths are those of the
//! drawing's own coordinates: the size of the page does not count. What has no stroke, or is not displayed, is ignored,
//! and so are texts and images.

use kurbo::Affine;
use roxmltree::{Document, Node};
use svgtypes::{Color, Transform};

use super::colour;
use super::line::{DrawnLines, Line, Lines, Misread, flip};
use super::outline::{self, Outline};
use super::svg_shape::{length, outline};
use super::svg_style::{Properties, Rules, Style};
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
        Drawing { document: &document, rules: Rules::new(&document)?, elements: 0, grey: 0, outlines: vec![] };
    drawing.read(root, &Around::default(), 0)?;
    let mut drawn = DrawnLines { title: title.unwrap_or_default().trim().to_owned(), ..DrawnLines::default() };
    drawn.redrawing.grey = drawing.grey;
    outline::draw(&drawing.outlines, &mut drawn);
    if drawn.lines.is_empty() {
        return Err(([1, 1], PatternFault::Empty { right: "draw shapes with a coloured stroke" }.into()));
    }
    Ok(drawn)
}

/// Properties that an element inherits from the elements around it.
#[derive(Clone, Copy, Default)]
struct Around {
    style: Style,
    transform: Affine,
}

struct Drawing<'d, 'input> {
    document: &'d Document<'input>,
    rules: Rules<'d>,
    elements: usize,
    /// Number of grey shapes.
    grey: usize,
    outlines: Vec<Outline>,
}

impl<'d, 'input> Drawing<'d, 'input> {
    /// Reads an element and those in it.
    fn read(&mut self, node: Node<'d, 'input>, around: &Around, depth: usize) -> Result<(), Misread> {
        let document = self.document;
        let located = |fault: PatternFault| (xml::place(document, node), Box::from(fault));
        self.elements += 1;
        if depth > DEEPEST || self.elements > MOST_ELEMENTS {
            let right = "there should be at most 1,000,000 of them, clones included, and at most 200 in each other";
            return Err(located(PatternFault::Element { element: "too many elements".into(), right }));
        }
        let properties = self.rules.properties(node);
        let mut here = around.with(&properties).map_err(located)?;
        if !here.style.displayed {
            return Ok(());
        }
        match node.tag_name().name() {
            "svg" | "symbol" if depth > 0 && node.has_attribute("viewBox") => {
                let element = format!("`{}` with a `viewBox` of its own", node.tag_name().name());
                Err(located(PatternFault::Element { element, right: "only the outermost `svg` should have one" }))
            }
            // without languages or features of its own the first child is the one that applies
            "switch" => node.first_element_child().map_or(Ok(()), |child| self.read(child, &here, depth + 1)),
            "svg" | "g" | "a" | "symbol" => {
                if depth > 0 && node.tag_name().name() == "svg" {
                    here.shift(node).map_err(located)?;
                }
                // symbols are drawn where they are used
                let drawn = node.children().filter(|child| child.is_element() && child.tag_name().name() != "symbol");
                drawn.into_iter().try_for_each(|child| self.read(child, &here, depth + 1))
            }
            "use" => {
                here.shift(node).map_err(located)?;
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

    fn shape(&mut self, node: Node, here: &Around) -> Result<(), PatternFault> {
        let Some(colour) = here.style.stroke.filter(|colour| here.style.visible && colour.alpha > 0) else {
            return Ok(());
        };
        let Some(outline) = outline(node)? else { return Ok(()) };
        let rgb = [colour.red, colour.green, colour.blue];
        let [red, green, blue] = rgb;
        let name = || format!("#{red:02x}{green:02x}{blue:02x}");
        let wrong = || PatternFault::value(&name(), "colour of a line", colour::RIGHT);
        let auxiliary = colour::is_grey(rgb);
        self.grey += usize::from(auxiliary);
        let letter = colour::letter(rgb).or(auxiliary.then_some(Assignment::Flat)).ok_or_else(wrong)?;
        let angle = angle(letter, here.style.opacity * here.style.stroke_opacity, colour);
        let ends = [Vec2::zeros(); 2];
        let line = Line { ends, letter, angle, auxiliary, contour: false, at: node.range().start, flipped: true };
        self.outlines.push(Outline { path: here.placed() * outline, line, named: false });
        Ok(())
    }
}

/// Whether a list of lengths is that of the origin.
fn is_origin(text: &str) -> bool {
    text.split_whitespace().all(|length| ["0", "0px", "0%"].contains(&length))
}

/// Returns the target angle in degrees of a line of this opacity.
fn angle(letter: Assignment, opacity: f64, colour: Color) -> Option<f64> {
    let folded = opacity * f64::from(colour.alpha) / 255.0 * 180.0;
    match letter {
        Assignment::Mountain => Some(flip(folded)),
        Assignment::Valley => Some(folded),
        Assignment::Flat => Some(0.0),
        _ => None,
    }
}

impl Around {
    /// Returns what an element with these properties says to those in it.
    fn with(&self, properties: &Properties) -> Result<Self, PatternFault> {
        let style = self.style.of(properties)?;
        let Some(text) = properties.get("transform").filter(|text| **text != "none") else {
            return Ok(Self { style, ..*self });
        };
        if let Some(origin) = properties.get("transform-origin").filter(|origin| !is_origin(origin)) {
            return Err(PatternFault::value(
                origin,
                "origin of a transform that is read",
                "`0 0`, and the shift a part of `transform`",
            ));
        }
        let wrong = |_| PatternFault::value(text, "transform", "`translate(1 2)`, `matrix(1 0 0 1 0 0)` or the like");
        let Transform { a, b, c, d, e, f } = text.parse().map_err(wrong)?;
        Ok(Self { style, transform: self.transform * Affine::new([a, b, c, d, e, f]) })
    }

    /// Translates by the attributes `x` and `y` of an element.
    fn shift(&mut self, node: Node) -> Result<(), PatternFault> {
        self.transform *= Affine::translate((length(node, "x")?, length(node, "y")?));
        Ok(())
    }

    /// Returns the transform from an element to the sheet, whose y points upwards.
    fn placed(&self) -> Affine {
        let [a, b, c, d, e, f] = self.transform.as_coeffs();
        Affine::new([a, flip(b), c, flip(d), e, flip(f)])
    }
}
