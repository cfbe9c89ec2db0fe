//! The strokes of SVG elements: attributes, style sheets and `style`, with what is inherited.

use std::collections::BTreeMap;

use roxmltree::{Document, Node};
use simplecss::{AttributeOperator, DeclarationTokenizer, PseudoClass, Selector, StyleSheet};
use svgtypes::{Color, Length, Paint};

use super::line::Misread;
use super::xml;
use crate::sheet::pattern_fault::PatternFault;

/// The properties that are used here.
const USED: [&str; 10] = [
    "stroke",
    "stroke-opacity",
    "opacity",
    "display",
    "visibility",
    "color",
    "transform",
    "transform-origin",
    "stop-color",
    "stop-opacity",
];

/// Properties of sizes. A rule whose selectors cannot be read may have them: what it leaves out is a size, no line.
const SIZES: [&str; 2] = ["stroke-width", "font-size"];

/// A colour and its opacity, from 0 to 1.
type Ink = (Color, f64);

/// How elements are drawn, as far as a crease pattern needs it.
#[derive(Clone, Copy, Debug)]
pub(super) struct SvgStyle {
    /// Colour of the stroke and its opacity, from 0 to 1; `None` for shapes without one.
    pub stroke: Option<Ink>,
    /// Whether the stroke has a width.
    pub wide: bool,
    /// Opacity of the stroke alone, from 0 to 1.
    pub stroke_opacity: f64,
    /// Opacity of the element and all groups around it.
    pub opacity: f64,
    /// Whether the element is visible.
    pub visible: bool,
    /// Whether the element and those in it are drawn at all.
    pub displayed: bool,
    /// The colour `currentColor`, and its opacity.
    color: Ink,
}

impl Default for SvgStyle {
    fn default() -> Self {
        let (opacity, color) = (1.0, (Color::black(), 1.0));
        Self { stroke: None, wide: true, stroke_opacity: opacity, opacity, visible: true, displayed: true, color }
    }
}

/// The rules of all style sheets of a document.
pub(super) struct Rules<'a>(StyleSheet<'a>);

/// Returns the fault of the first rule for a property that is used here whose selector is none of those that are read,
/// or that is inside another one, as those of `@media`; without it, which the parser leaves out, lines would have other
/// letters.
fn unread(text: &str) -> Option<PatternFault> {
    let mut inside = 0;
    let bare: String = text.split("/*").map(|part| part.split_once("*/").map_or(part, |(_, rest)| rest)).collect();
    let selectors = bare.split('}').find_map(|rule| {
        let level = inside + rule.matches('{').count();
        inside = level.saturating_sub(1);
        let (selectors, properties) = rule.rsplit_once('{')?;
        let mut properties = DeclarationTokenizer::from(properties);
        let is_read = level == 1 && selectors.split(',').all(|one| Selector::parse(one.trim()).is_some());
        (!is_read && properties.any(|property| USED.contains(&property.name))).then_some(selectors.trim().to_owned())
    })?;
    let right = "made of names, classes, ids and attributes of elements, and in no other rule";
    Some(PatternFault::value(&selectors, "selector of a style sheet that is read", right))
}

/// The values of the properties of an element.
pub(super) type Properties<'a> = BTreeMap<&'a str, &'a str>;

impl<'a> Rules<'a> {
    pub(super) fn new(document: &'a Document) -> Result<Self, Misread> {
        let mut rules = StyleSheet::new();
        for sheet in document.descendants().filter(|node| node.tag_name().name() == "style") {
            for text in sheet.children().filter_map(|child| child.text()) {
                unread(text).map_or(Ok(()), |fault| Err((xml::place(document, sheet), Box::from(fault))))?;
                rules.parse_more(text);
            }
        }
        Ok(Self(rules))
    }

    /// Returns the properties that an element is given; important rules come before `style`, that before other rules,
    /// and they before attributes.
    pub(super) fn properties(&self, node: Node<'a, '_>) -> Properties<'a> {
        let attributes = node.attributes().filter(|attribute| attribute.namespace().is_none());
        let attributes = attributes.map(|attribute| (attribute.name(), attribute.value()));
        let attributes: Vec<(String, &str)> = attributes.map(|(name, value)| (name.to_owned(), value)).collect();
        let matching: Vec<_> = self.0.rules.iter().filter(|rule| rule.selector.matches(&SvgElement(node))).collect();
        let ruled = |important: bool| {
            let declared = matching.iter().flat_map(|rule| &rule.declarations);
            declared.filter(move |d| d.important == important).map(|d| (d.name, d.value)).collect::<Vec<_>>()
        };
        let own = DeclarationTokenizer::from(node.attribute("style").unwrap_or_default()).map(|d| (d.name, d.value));
        let attributes = attributes.iter().map(|(name, value)| (name.as_str(), *value));
        let mut properties = Properties::new();
        for (name, value) in attributes.chain(ruled(false)).chain(own).chain(ruled(true)) {
            if let Some(known) = USED.iter().chain(&SIZES).find(|known| **known == name) {
                properties.insert(known, value.trim());
            }
        }
        properties
    }
}

impl SvgStyle {
    /// Returns the style of an element in one of this style.
    pub(super) fn of(&self, properties: &Properties) -> Result<Self, PatternFault> {
        let given = |name: &str| properties.get(name).copied().filter(|value| *value != "inherit");
        let mut style = *self;
        if let Some(text) = given("color") {
            let wrong = |_| PatternFault::value(text, "colour", "`#f00`, `red` or `rgb(255, 0, 0)`");
            style.color = text.parse().map(|color| (color, alpha(text, color))).map_err(wrong)?;
        }
        if let Some(text) = given("stroke") {
            style.stroke = stroke(text, style.color, self.stroke)?;
        }
        if let Some(text) = given("stroke-width") {
            style.wide = !text.parse().is_ok_and(|width: Length| width.number == 0.0);
        }
        if let Some(text) = given("stroke-opacity") {
            style.stroke_opacity = opacity(text)?;
        }
        if let Some(text) = given("opacity") {
            style.opacity = self.opacity * opacity(text)?;
        }
        style.displayed = self.displayed && given("display") != Some("none");
        if let Some(text) = given("visibility") {
            style.visible = text == "visible";
        }
        Ok(style)
    }
}

fn stroke(text: &str, color: Ink, inherited: Option<Ink>) -> Result<Option<Ink>, PatternFault> {
    let right = "a colour, `#f00`, `red` or `rgb(255, 0, 0)`, a gradient of one colour, or `none`";
    match Paint::from_str(text) {
        Ok(Paint::None) => Ok(None),
        Ok(Paint::Inherit) => Ok(inherited),
        Ok(Paint::CurrentColor) => Ok(Some(color)),
        Ok(Paint::Color(color)) => Ok(Some((color, alpha(text, color)))),
        _ => Err(PatternFault::value(text, "colour of a stroke", right)),
    }
}

/// Returns the opacity that the text of a colour gives it, which the colour itself has in steps of 1/255.
fn alpha(text: &str, color: Color) -> f64 {
    let last =
        text.trim_end().strip_suffix(')').and_then(|text| text.rsplit([',', '/', ' ']).find(|part| !part.is_empty()));
    let written = last.filter(|_| color.alpha < 255).and_then(|last| opacity(last).ok());
    written.unwrap_or(f64::from(color.alpha) / 255.0)
}

fn opacity(text: &str) -> Result<f64, PatternFault> {
    let number = match text.strip_suffix('%') {
        Some(percent) => percent.trim().parse().map(|number: f64| number / 100.0),
        None => text.parse(),
    };
    let part = number.ok().filter(|number: &f64| number.is_finite()).map(|number| number.clamp(0.0, 1.0));
    part.ok_or_else(|| PatternFault::value(text, "opacity", "a number from 0 to 1"))
}

/// An element whose selectors are matched.
struct SvgElement<'a, 'input>(Node<'a, 'input>);

impl simplecss::Element for SvgElement<'_, '_> {
    fn parent_element(&self) -> Option<Self> {
        self.0.parent_element().map(SvgElement)
    }

    fn prev_sibling_element(&self) -> Option<Self> {
        self.0.prev_sibling_element().map(SvgElement)
    }

    fn has_local_name(&self, name: &str) -> bool {
        self.0.tag_name().name() == name
    }

    fn attribute_matches(&self, local_name: &str, operator: AttributeOperator<'_>) -> bool {
        self.0.attribute(local_name).is_some_and(|value| operator.matches(value))
    }

    fn pseudo_class_matches(&self, class: PseudoClass<'_>) -> bool {
        class == PseudoClass::FirstChild && self.0.prev_sibling_element().is_none()
    }
}
