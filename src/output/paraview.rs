//! A script beside a series of states that shows it in ParaView.

/// The script, with the word `SERIES_NAME` where the name of the series belongs.
const TEMPLATE: &str = include_str!("paraview.py");

/// Returns the script that shows `NAME.pvd`, which is in the same folder. Names of studies need no escaping.
pub(crate) fn script(name: &str) -> String {
    TEMPLATE.replace("SERIES_NAME", name)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: the script names its series and nothing else is left to fill in.
    #[test]
    fn the_series_is_named() {
        let text = script("loops");
        assert!(text.contains("\"loops.pvd\"") && text.contains("pvpython loops-paraview.py"));
        assert!(!text.contains("SERIES_NAME"));
    }
}
