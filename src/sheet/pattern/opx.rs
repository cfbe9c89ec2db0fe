//! ORIPA's `.opx` files: the lines as Java beans in XML.
//!
//! ```text
//! <object class="oripa.OriLineProxy">
//!   <void property="type"><int>2</int></void>
//!   <void property="x0"><double>-200.0</double></void>     (properties of value 0 are left out)
//!   ...
//! ```

use roxmltree::Node;

use super::cp::{self, LineType, typed};
use super::line::{DrawnLines, Lines, PatternLine};
use super::xml;
use crate::sheet::assignment::Assignment;
use crate::sheet::pattern_fault::PatternFault;

/// Ending of the Java class of a line: `oripa.OriLineProxy`, in later versions in another package.
const LINE: &str = "OriLineProxy";

/// The types of ORIPA; lines of type 4 are not yet mountain or valley.
const TYPES: [LineType; 5] =
    [cp::TYPES[0], cp::TYPES[1], cp::TYPES[2], cp::TYPES[3], (4, Assignment::Unassigned, None, false)];

/// The types as messages name them.
const RIGHT: &str = "1 (boundary), 2 (mountain), 3 (valley), 4 (unassigned) or 0 (auxiliary)";

/// Reads the lines of a text.
pub(super) fn lines(text: &str) -> Lines {
    let document = xml::document(text, "an OPX file")?;
    let objects = document.descendants().filter(|node| node.attribute("class").is_some_and(|c| c.ends_with(LINE)));
    let objects = objects.filter(|node| node.has_tag_name("object"));
    let title = document.descendants().find(|node| node.attribute("property") == Some("title"));
    let title = title.and_then(|node| node.first_element_child()).and_then(|node| node.text()).unwrap_or_default();
    let mut drawn = DrawnLines { title: title.trim().to_owned(), ..DrawnLines::default() };
    for object in objects {
        drawn.push(line(object).map_err(|fault| (xml::place(&document, object), fault.into()))?);
    }
    Ok(drawn)
}

fn line(object: Node) -> Result<PatternLine, PatternFault> {
    let given = |name: &str| {
        let property = object.children().find(|node| node.attribute("property") == Some(name))?;
        Some(property.first_element_child().and_then(|node| node.text()).unwrap_or_default().trim())
    };
    let numbers = cp::numbers(["x0", "y0", "x1", "y1"].map(|name| given(name).unwrap_or("0")))?;
    typed(given("type").unwrap_or("0"), (&TYPES, RIGHT), numbers, object.range().start)
}
