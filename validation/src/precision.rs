//! Error against run time of methods at several settings.

use foldwell::output::figure::chart::{DataPoint, LineChart, Series};
use serde::Serialize;
use std::time::Instant;

/// The errors for which the cheapest setting is listed.
const WANTED: [f64; 5] = [1e-2, 1e-4, 1e-6, 1e-9, 1e-12];

/// A setting of a method, with its error and its run time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Setting {
    /// Name of the setting, such as `"k = 1e6"`.
    pub label: String,
    /// Error of the result; NaN without a result.
    pub error: f64,
    /// Run time in seconds, the median of several runs.
    pub seconds: f64,
}

/// A method at several settings.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Method {
    /// Name.
    pub name: String,
    /// Settings.
    pub settings: Vec<Setting>,
}

/// A diagram of error against run time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Diagram {
    /// Title, which names the varied quantity.
    pub title: String,
    /// Definition of the error, and the reference.
    pub error: String,
    /// Methods to compare.
    pub methods: Vec<Method>,
}

impl Diagram {
    /// Returns the diagram as a chart.
    pub fn chart(&self) -> LineChart {
        let point = |s: &Setting| DataPoint { x: s.error, y: s.seconds, label: s.label.clone() };
        let series = |m: &Method| Series { name: m.name.clone(), points: m.settings.iter().map(point).collect() };
        LineChart {
            title: self.title.clone(),
            x: self.error.clone(),
            y: "seconds".into(),
            series: self.methods.iter().map(series).collect(),
            ..LineChart::default()
        }
    }

    /// Returns, for each error of a list, the method and setting that reach it in the shortest time; `None` if none
    /// does.
    pub fn cheapest(&self) -> Vec<(f64, Option<(&str, &Setting)>)> {
        let all = || self.methods.iter().flat_map(|m| m.settings.iter().map(move |s| (m.name.as_str(), s)));
        let best = |wanted: f64| {
            let good = all().filter(|(_, setting)| setting.error <= wanted);
            good.min_by(|a, b| a.1.seconds.total_cmp(&b.1.seconds))
        };
        WANTED.iter().map(|&wanted| (wanted, best(wanted))).collect()
    }
}

/// Returns the median run time of each piece of `work` over `rounds` rounds, the upper one of an even number. The
/// pieces are run by turns, so that other load on the machine affects all of them alike.
pub fn medians(rounds: usize, work: &mut [Box<dyn FnMut() + '_>]) -> Vec<f64> {
    let mut times = vec![Vec::with_capacity(rounds); work.len()];
    for _ in 0..rounds {
        for (times, work) in times.iter_mut().zip(work.iter_mut()) {
            let clock = Instant::now();
            work();
            times.push(clock.elapsed().as_secs_f64());
        }
    }
    times.iter_mut().for_each(|times| times.sort_by(f64::total_cmp));
    times.iter().map(|times| times[rounds / 2]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: the cheapest setting is the fastest of those with a small enough error, over all methods; a setting
    /// without a result is ignored.
    #[test]
    fn the_cheapest_setting_is_named() {
        let setting = |label: &str, error, seconds| Setting { label: label.into(), error, seconds };
        let method = |name: &str, settings| Method { name: name.into(), settings };
        let methods = vec![
            method("a", vec![setting("1", 1e-3, 1.0), setting("2", 1e-7, 3.0), setting("3", f64::NAN, 0.1)]),
            method("b", vec![setting("4", 1e-5, 2.0)]),
        ];
        let diagram = Diagram { title: String::new(), error: String::new(), methods };
        let found: Vec<_> = diagram.cheapest().into_iter().map(|(_, best)| best.map(|(m, s)| (m, &*s.label))).collect();
        assert_eq!(found, [Some(("a", "1")), Some(("b", "4")), Some(("a", "2")), None, None]);
        assert_eq!(diagram.chart().series[0].points.len(), 3);
    }
}
