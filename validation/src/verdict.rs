//! Comparison of a value with the requirement of a claim.

use super::claim::{Numbers, Wanted};
use serde_json::Value;

/// The result of a comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// Whether the claim holds.
    pub passed: bool,
    /// Distance of the worst number from its expected value, or beyond its bound (negative if within); NaN if numbers
    /// are missing.
    pub miss: f64,
    /// Tolerance of that number.
    pub tolerance: f64,
}

/// Compares numbers with a requirement. A missing number and NaN fail.
pub fn compare(wanted: &Wanted, found: &Numbers) -> Verdict {
    let bounded = |beyond: fn(f64, f64) -> f64, bound: f64| {
        let each = found.list().iter().map(|number| (beyond(*number, bound), 0.0));
        worst(each.collect())
    };
    match wanted {
        Wanted::AtMost(bound) => bounded(|number, bound| number - bound, *bound),
        Wanted::AtLeast(bound) => bounded(|number, bound| bound - number, *bound),
        Wanted::Equal { numbers, .. } if numbers.list().len() != found.list().len() => worst(vec![]),
        Wanted::Equal { numbers, absolute, relative } => {
            let pairs = found.list().iter().zip(numbers.list());
            worst(pairs.map(|(found, number)| ((found - number).abs(), absolute + relative * number.abs())).collect())
        }
    }
}

/// Returns the verdict on the worst of pairs of a distance and its tolerance; an empty list fails.
fn worst(each: Vec<(f64, f64)>) -> Verdict {
    let passed = !each.is_empty() && each.iter().all(|(miss, tolerance)| miss <= tolerance);
    let beyond = |(miss, tolerance): &(f64, f64)| if miss.is_nan() { f64::INFINITY } else { miss - tolerance };
    let worst = each.iter().max_by(|a, b| beyond(a).total_cmp(&beyond(b)));
    let (miss, tolerance) = worst.copied().unwrap_or((f64::NAN, 0.0));
    Verdict { passed, miss, tolerance }
}

/// Returns the numbers at a path in a JSON value, such as `studies.loops.branches.*.arc_length`.
///
/// The steps between dots are keys of tables, indices in lists, names of the entries of a list that have a `name`, `*`
/// for all entries of a list, or `6..10` for the entries 6 to 9. True counts as 1 and false as 0. `None` if there is no
/// number at the path.
pub fn numbers_at(value: &Value, path: &str) -> Option<Numbers> {
    let mut several = false;
    let mut values = vec![value];
    for step in path.replace("..", "\u{0}").split('.') {
        let mut next = Vec::new();
        for value in values {
            match (value, step.split_once('\u{0}')) {
                (Value::Array(list), Some((from, to))) => {
                    next.extend(list.get(from.parse().ok()?..to.parse().ok()?)?);
                    several = true;
                }
                (Value::Array(list), None) if step == "*" => {
                    next.extend(list);
                    several = true;
                }
                (Value::Array(list), None) => {
                    let named = || list.iter().find(|entry| entry["name"] == step);
                    next.push(step.parse::<usize>().ok().and_then(|at| list.get(at)).or_else(named)?);
                }
                (value, _) => next.push(value.get(step)?),
            }
        }
        values = next;
    }
    let flat: Vec<&Value> = values.into_iter().flat_map(entries).collect();
    let numbers: Vec<f64> = flat.iter().map(|value| number(value)).collect::<Option<_>>()?;
    match numbers[..] {
        [] => None,
        [one] if !several => Some(Numbers::One(one)),
        _ => Some(Numbers::Many(numbers)),
    }
}

fn entries(value: &Value) -> Vec<&Value> {
    value.as_array().map_or_else(|| vec![value], |list| list.iter().collect())
}

fn number(value: &Value) -> Option<f64> {
    value.as_f64().or_else(|| value.as_bool().map(f64::from))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn equal(numbers: &[f64], absolute: f64, relative: f64) -> Wanted {
        Wanted::Equal { numbers: Numbers::Many(numbers.to_vec()), absolute, relative }
    }

    /// Claim: the worst number decides, and the verdict has its distance; expected values computed by hand.
    #[test]
    fn the_worst_number_decides() {
        let found = Numbers::Many(vec![1.25, 10.0, 3.0]);
        let verdict = compare(&equal(&[1.0, 10.5, 3.0], 0.25, 0.0), &found);
        assert_eq!(verdict, Verdict { passed: false, miss: 0.5, tolerance: 0.25 });
        let verdict = compare(&equal(&[1.0, 10.5, 3.0], 0.25, 0.25), &found);
        assert!(verdict.passed);
        let verdict = compare(&Wanted::AtMost(4.0), &found);
        assert_eq!(verdict, Verdict { passed: false, miss: 6.0, tolerance: 0.0 });
        assert_eq!(compare(&Wanted::AtLeast(1.25), &found), Verdict { passed: true, miss: 0.0, tolerance: 0.0 });
    }

    /// Claim: missing numbers, too many numbers, and NaN never pass.
    #[test]
    fn what_is_no_number_fails() {
        for found in [vec![], vec![1.0], vec![1.0, 2.0, 3.0], vec![1.0, f64::NAN]] {
            assert!(!compare(&equal(&[1.0, 2.0], 9.0, 0.0), &Numbers::Many(found.clone())).passed, "{found:?}");
        }
        for bound in [Wanted::AtMost(1.0), Wanted::AtLeast(1.0)] {
            for found in [vec![], vec![f64::NAN], vec![1.0, f64::NAN]] {
                assert!(!compare(&bound, &Numbers::Many(found)).passed);
            }
        }
    }

    /// Claim: every kind of step finds its value; a path without value gives `None`.
    #[test]
    fn paths_lead_to_numbers() {
        let json = json!({ "studies": [{ "name": "a", "x": 1 }, { "name": "b", "list": [1, 2, 3, 4], "yes": true }] });
        let at = |path| numbers_at(&json, path);
        assert_eq!(at("studies.a.x"), Some(Numbers::One(1.0)));
        assert_eq!(at("studies.1.list.2"), Some(Numbers::One(3.0)));
        assert_eq!(at("studies.b.list"), Some(Numbers::Many(vec![1.0, 2.0, 3.0, 4.0])));
        assert_eq!(at("studies.b.list.1..3"), Some(Numbers::Many(vec![2.0, 3.0])));
        assert_eq!(at("studies.b.list.*"), at("studies.b.list"));
        assert_eq!(at("studies.b.yes"), Some(Numbers::One(1.0)));
        for path in ["studies.c.x", "studies.a.name", "studies.b.list.3..9", "studies.*.x", ""] {
            assert_eq!(at(path), None, "{path}");
        }
    }
}
