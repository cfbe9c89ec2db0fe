//! The canvas: writes the elements of an SVG, and places text without overlaps.
//!
//! Coordinates are `[right, down]` from the upper left corner. The width of every figure is 1,200 units, so that
//! letters and lines have the same size in all figures.

use std::fmt::Write;

use super::palette::{Colour, INK, PAPER, Ramp};
use super::script;
use super::style::{Anchor, Area, Font, PaperPoint, Short, Style, escaped};

/// Width of every figure.
pub(crate) const WIDTH: f64 = 1200.0;
/// Left and right margin of the caption.
pub(crate) const MARGIN: f64 = 48.0;
/// Height of the area of the caption.
pub(crate) const HEAD: f64 = 84.0;

/// The caption at the top of a figure.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Caption {
    /// Title of the scene.
    pub title: String,
    /// Name of the state or result that is shown.
    pub state: String,
}

/// The symbol before an entry of a legend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Mark {
    /// A line.
    Line(Style),
    /// A circle of this radius, filled or not.
    Circle(f64, Style),
    /// No symbol.
    None,
}

/// A figure that is being drawn.
pub(crate) struct Canvas {
    height: f64,
    text: String,
    /// Areas of text.
    texts: Vec<Area>,
    /// Other areas that text must not cover.
    taken: Vec<Area>,
}

/// Appends formatted text to a string, which does not fail.
macro_rules! put {
    ($text:expr, $($format:tt)*) => {{ let _ = write!($text, $($format)*); }};
}

impl Canvas {
    /// Makes a canvas with its caption at the top; long captions have smaller letters so that they fit.
    pub(crate) fn new(height: f64, caption: &Caption) -> Self {
        let title = escaped(&caption.title);
        let text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height:.0}\" width=\"{WIDTH}\" \
             height=\"{height:.0}\" font-family=\"Helvetica, Arial, sans-serif\" fill=\"{INK}\">\n\
             <title>{title}</title>\n\
             <defs><filter id=\"soft\"><feGaussianBlur stdDeviation=\"7\"/></filter></defs>\n\
             <rect width=\"{WIDTH}\" height=\"{height:.0}\" rx=\"14\" fill=\"{PAPER}\"/>\n"
        );
        let mut canvas = Self { height, text, texts: Vec::new(), taken: Vec::new() };
        for (words, font, foot) in [(&caption.title, Font::TITLE, 42.0), (&caption.state, Font::STATE, 70.0)] {
            let room = (WIDTH - 2.0 * MARGIN) / font.width(words).max(1.0);
            canvas.text([MARGIN, foot], words, Font { size: font.size * room.min(1.0), ..font });
        }
        canvas
    }

    /// Returns the SVG.
    pub(crate) fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }

    /// Begins a group in which lines without a width of their own have this width, with round joints and ends.
    pub(crate) fn group(&mut self, width: f64) {
        put!(self.text, "<g stroke-width=\"{width}\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n");
    }

    /// Begins a group with a tooltip.
    pub(crate) fn told(&mut self, words: &str) {
        put!(self.text, "<g><title>{}</title>", escaped(words));
    }

    /// Ends the innermost group.
    pub(crate) fn end(&mut self) {
        self.text.push_str("</g>\n");
    }

    /// Draws a line through points.
    pub(crate) fn line(&mut self, places: &[PaperPoint], style: Style) {
        self.path(&[places], false, style, "");
    }

    /// Draws a polygon.
    pub(crate) fn polygon(&mut self, corners: &[PaperPoint], style: Style) {
        self.path(&[corners], true, style, "");
    }

    /// Draws polygons as one element; overlapping polygons of the same orientation form one area.
    pub(crate) fn polygons(&mut self, polygons: &[impl AsRef<[PaperPoint]>], style: Style) {
        self.path(polygons, true, style, "");
    }

    /// Draws polygons as one element with blurred borders.
    pub(crate) fn shadow(&mut self, polygons: &[impl AsRef<[PaperPoint]>], colour: Colour) {
        self.path(polygons, true, Style::tile(colour), " filter=\"url(#soft)\"");
    }

    fn path(&mut self, parts: &[impl AsRef<[PaperPoint]>], closed: bool, style: Style, more: &str) {
        self.text.push_str("<path d=\"");
        for part in parts {
            for (k, [x, y]) in part.as_ref().iter().enumerate() {
                put!(self.text, "{}{} {}", if k == 0 { "M" } else { " " }, Short(*x, 1), Short(*y, 1));
            }
            self.text.push_str(if closed { "Z" } else { "" });
        }
        put!(self.text, "\"{style}{more}/>\n");
    }

    /// Draws a circle.
    pub(crate) fn circle(&mut self, [x, y]: PaperPoint, radius: f64, style: Style) {
        put!(self.text, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{}\"{style}/>\n", Short(radius, 1));
    }

    /// Draws text with its anchor at `place`, on the base line.
    pub(crate) fn text(&mut self, place: PaperPoint, words: &str, font: Font) {
        if !words.is_empty() {
            self.texts.push(font.area(place, words));
        }
        let (font, place, content) = written(font, place, words);
        let [x, y] = place.map(|x| Short(x, 1));
        match font.turned {
            true => put!(self.text, "<text transform=\"translate({x} {y}) rotate(-90)\""),
            false => put!(self.text, "<text x=\"{x}\" y=\"{y}\""),
        }
        put!(self.text, " font-size=\"{}\"", Short(font.size, 1));
        match font.anchor {
            Anchor::Start => {}
            Anchor::Middle => self.text.push_str(" text-anchor=\"middle\""),
            Anchor::End => self.text.push_str(" text-anchor=\"end\""),
        }
        self.text.push_str(if font.bold { " font-weight=\"bold\"" } else { "" });
        if font.colour != INK {
            put!(self.text, " fill=\"{}\"", font.colour);
        }
        put!(self.text, ">{content}</text>\n");
    }

    /// Reserves an area: `text_within` sets no text there.
    pub(crate) fn take(&mut self, area: Area) {
        self.taken.push(area);
    }

    /// Reserves the area within this distance of a straight line.
    pub(crate) fn take_line(&mut self, from: PaperPoint, to: PaperPoint, distance: f64) {
        let steps = ((to[0] - from[0]).hypot(to[1] - from[1]) / 6.0).ceil().max(1.0);
        let at = |part: f64| [0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis]));
        (0..=steps as usize).for_each(|k| self.take(Area::around(at(k as f64 / steps), distance)));
    }

    /// Sets text at the first of some places where it lies within `room` and overlaps no reserved area. Returns
    /// `false`, and sets no text, if there is no such place.
    pub(crate) fn text_within(
        &mut self,
        room: Area,
        places: impl IntoIterator<Item = (PaperPoint, Font)>,
        words: &str,
    ) -> bool {
        let found = places.into_iter().find(|(place, font)| {
            let area = font.area(*place, words);
            let within = (0..2).all(|k| area.low[k] >= room.low[k] && area.high[k] <= room.high[k]);
            within && self.texts.iter().chain(&self.taken).all(|other| area.common(other) == 0.0)
        });
        found.map(|(place, font)| self.text(place, words, font)).is_some()
    }

    /// Returns the area of the figure without a narrow border.
    pub(crate) fn paper(&self) -> Area {
        Area { low: [6.0, 6.0], high: [WIDTH - 6.0, self.height - 6.0] }
    }

    /// Draws a legend, symbols followed by text, in a row that starts at the given point, and in further rows if
    /// needed.
    pub(crate) fn legend(&mut self, [left, top]: PaperPoint, entries: &[(Mark, impl AsRef<str>)]) {
        let ([mut x, mut y], font) = ([left, top], Font::SMALL);
        for (mark, words) in entries.iter().map(|(mark, words)| (*mark, words.as_ref())) {
            let sign = match mark {
                Mark::Line(_) => 48.0,
                Mark::Circle(radius, _) => 2.0 * radius + 8.0,
                Mark::None => 0.0,
            };
            let width = sign + font.width(words);
            if x > left && x + width > WIDTH - 12.0 {
                (x, y) = (left, y + 26.0);
            }
            match mark {
                Mark::Line(style) => self.line(&[[x, y - 5.5], [x + 38.0, y - 5.5]], style),
                Mark::Circle(radius, style) => self.circle([x + radius, y - 5.5], radius, style),
                Mark::None => {}
            }
            self.text([x + sign, y], words, font);
            x += width + 30.0;
        }
    }

    /// Draws a vertical colour bar: its name above it, and labels to its right at parts from 0 (bottom) to 1 (top).
    pub(crate) fn colour_bar(&mut self, area: Area, ramp: Ramp, name: &str, ticks: &[(f64, String)]) {
        let ([left, top], [right, bottom]) = (area.low, area.high);
        self.text.push_str("<defs><linearGradient id=\"colours\" x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\">");
        for (part, colour) in ramp.stops() {
            put!(self.text, "<stop offset=\"{}\" stop-color=\"{colour}\"/>", Short(part, 3));
        }
        self.text.push_str("</linearGradient></defs>\n");
        let (width, height) = (right - left, bottom - top);
        put!(
            self.text,
            "<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" fill=\"url(#colours)\"/>\n"
        );
        for (part, words) in ticks {
            let y = bottom - part * height;
            self.line(&[[right, y], [right + 5.0, y]], Style::line(INK, 1.0));
            self.text([right + 10.0, y + 6.0], words, Font::SMALL);
        }
        let middle = (0.5 * (left + right)).min(WIDTH - 12.0 - 0.5 * Font::LABEL.bold().width(name));
        self.text([middle, top - 22.0], name, Font::LABEL.bold().middle());
    }
}

/// Returns the content of the element of a text, with its font and place: text with subscripts or superscripts begins
/// at its place.
fn written(font: Font, [x, y]: PaperPoint, words: &str) -> (Font, PaperPoint, String) {
    if !script::has_script(words) {
        return (font, [x, y], escaped(words));
    }
    let width = script::width(words, font.size);
    let before = font.anchor.part() * width;
    let place = if font.turned { [x, y + before] } else { [x - before, y] };
    (Font { anchor: Anchor::Start, ..font }, place, script::spans(words, font.size))
}

#[cfg(test)]
mod tests {
    use super::*;

    impl Canvas {
        /// Returns the number of texts that overlap reserved areas or texts before them, or end beyond the figure.
        pub(crate) fn crowded(&self) -> usize {
            let is_crowded = |(k, area): &(usize, &Area)| {
                let [x, y] = area.high;
                let beyond = area.low.iter().any(|low| *low < 0.0) || x > WIDTH || y > self.height;
                beyond || self.texts[..*k].iter().chain(&self.taken).any(|other| area.common(other) > 0.0)
            };
            self.texts.iter().enumerate().filter(is_crowded).count()
        }
    }

    fn canvas(title: &str) -> Canvas {
        Canvas::new(300.0, &Caption { title: title.into(), state: "state".into() })
    }

    /// Claim: special characters of XML are escaped in titles, text and tooltips, and characters forbidden in XML are
    /// left out.
    #[test]
    fn escapes() {
        assert_eq!(escaped("a < \"b\" & c > d\u{1}\u{ffff}"), "a &lt; &quot;b&quot; &amp; c &gt; d");
        let mut canvas = canvas("t & u");
        canvas.told("x < y");
        canvas.text([10.0, 200.0], "p & q", Font::LABEL);
        canvas.end();
        let text = canvas.finish();
        for words in ["<title>t &amp; u</title>", "x &lt; y", "p &amp; q"] {
            assert!(text.contains(words), "{words}");
        }
    }

    /// Claim: a title of any length fits; short titles have the usual size.
    #[test]
    fn long_titles() {
        for letters in [0, 10, 300] {
            let canvas = canvas(&"x".repeat(letters));
            assert_eq!(canvas.crowded(), 0, "{letters}");
            assert_eq!(canvas.finish().contains("font-size=\"23\""), letters < 300);
        }
    }

    /// Claim: text that would overlap other text or a reserved area, or would end beyond the figure, is set at the next
    /// place, or not at all if there is none; text that is set on other text is counted.
    #[test]
    fn words_stay_apart() {
        let mut canvas = canvas("");
        let places = |canvas: &mut Canvas, places: &[PaperPoint]| {
            let before = canvas.text.len();
            let set = canvas.text_within(canvas.paper(), places.iter().map(|place| (*place, Font::LABEL)), "abc");
            set.then(|| canvas.text[before..].to_owned())
        };
        assert!(places(&mut canvas, &[[100.0, 200.0]]).unwrap().contains("x=\"100\""));
        assert!(places(&mut canvas, &[[110.0, 205.0], [1199.0, 200.0], [100.0, 230.0]]).unwrap().contains("y=\"230\""));
        canvas.take(Area::around([310.0, 250.0], 4.0));
        assert_eq!(places(&mut canvas, &[[300.0, 255.0]]), None);
        assert_eq!(canvas.crowded(), 0);
        canvas.text([105.0, 204.0], "on another", Font::LABEL);
        assert_eq!(canvas.crowded(), 1);
    }

    /// Claim: numbers are written with the fewest digits.
    #[test]
    fn short_numbers() {
        let short = [(1.0, 1), (-0.04, 1), (12.25, 1), (100.0, 0), (0.5, 2)].map(|(x, n)| Short(x, n).to_string());
        assert_eq!(short, ["1", "0", "12.2", "100", "0.5"]);
    }
}
