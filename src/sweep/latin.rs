//! Latin hypercubes (McKay, Beckman and Conover 1979): each key's range is cut into as many parts as there are points, and each part is used
//! once, in an order of its own.

use random::SplitMix64;
use serde_json::{Number, Value};

use super::study::Assignments;

/// Values of a key.
#[derive(Clone, Debug, PartialEq)]
pub enum Range {
    /// Whole numbers, both ends among them.
    Whole(i64, i64),
    /// Real numbers, the upper end left out.
    Real(f64, f64),
    /// One of these.
    Choice(Vec<Value>),
}

impl Range {
    /// Two numbers are the ends of a range, anything else in a list is a choice; `None` for what is no list, or an empty one.
    pub fn new(value: &Value) -> Option<Range> {
        let values = value.as_array().filter(|values| !values.is_empty())?;
        if let [low, high] = values.as_slice() {
            if let (Some(low), Some(high)) = (low.as_i64(), high.as_i64()) {
                return (low <= high).then_some(Range::Whole(low, high));
            }
            if let (Some(low), Some(high)) = (low.as_f64(), high.as_f64()) {
                return (low <= high).then_some(Range::Real(low, high));
            }
        }
        Some(Range::Choice(values.clone()))
    }

    /// The value at a share of the range, in [0, 1).
    fn at(&self, share: f64) -> Value {
        match self {
            Range::Whole(low, high) => {
                // The widest range has more numbers than an i64.
                let (low, high) = (i128::from(*low), i128::from(*high));
                let steps = (share * ((high - low) as f64 + 1.0)).floor() as i128;
                ((low + steps).min(high) as i64).into()
            }
            Range::Real(low, high) => {
                let width = high - low;
                // The widest range is wider than the largest number.
                let at = if width.is_finite() { low + share * width } else { low * (1.0 - share) + high * share };
                Number::from_f64(at).map_or(Value::Null, Value::Number)
            }
            Range::Choice(values) => values[((share * values.len() as f64) as usize).min(values.len() - 1)].clone(),
        }
    }
}

/// The points of a hypercube; the same seed gives the same points.
pub fn points(count: u64, seed: u64, columns: &[(String, Range)]) -> Vec<Assignments> {
    let mut rows: Vec<Assignments> = (0..count).map(|_| Vec::with_capacity(columns.len())).collect();
    for (number, (key, range)) in columns.iter().enumerate() {
        // A series a key, so that a further key leaves the others as they are.
        let mut lot = SplitMix64::new(seed.wrapping_mul(0x9e37_79b9).wrapping_add(number as u64));
        let mut order: Vec<u64> = (0..count).collect();
        for at in (1..order.len()).rev() {
            order.swap(at, lot.below(at as u64 + 1) as usize);
        }
        for (row, part) in rows.iter_mut().zip(order) {
            let within = (lot.unit() + 1.0) / 2.0;
            row.push((key.clone(), range.at((part as f64 + within) / count as f64)));
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_widest_range_has_both_ends() {
        let widest = Range::new(&serde_json::json!([i64::MIN, i64::MAX])).unwrap();
        assert_eq!([0.0, 0.5, 1.0].map(|share| widest.at(share)), [Value::from(i64::MIN), 0.into(), i64::MAX.into()]);
        let real = Range::new(&serde_json::json!([-1.7e308, 1.7e308])).unwrap();
        assert_eq!([0.0, 0.5].map(|share| real.at(share)), [Value::from(-1.7e308), 0.0.into()]);
        let positive = Range::new(&serde_json::json!([-1, i64::MAX])).unwrap();
        assert_eq!([0.0, 1.0].map(|share| positive.at(share)), [Value::from(-1), i64::MAX.into()]);
    }

    #[test]
    fn each_part_of_a_range_is_used_once() {
        let columns = [
            ("a".to_owned(), Range::new(&serde_json::json!([0, 99])).unwrap()),
            ("b".to_owned(), Range::new(&serde_json::json!([0.0, 1.0])).unwrap()),
            ("c".to_owned(), Range::new(&serde_json::json!(["x", "y", "z", "w"])).unwrap()),
        ];
        let points = points(100, 7, &columns);
        let of = |column: usize| points.iter().map(move |point| point[column].1.clone());
        let mut whole: Vec<i64> = of(0).map(|value| value.as_i64().unwrap()).collect();
        assert!(!whole.is_sorted());
        whole.sort_unstable();
        assert_eq!(whole, (0..100).collect::<Vec<_>>());
        let mut parts: Vec<i64> = of(1).map(|value| (value.as_f64().unwrap() * 100.0) as i64).collect();
        parts.sort_unstable();
        assert_eq!(parts, (0..100).collect::<Vec<_>>());
        assert_eq!(of(2).filter(|value| value == "y").count(), 25);
        assert_eq!(super::points(100, 7, &columns), points);
        assert_ne!(super::points(100, 8, &columns), points);
    }
}
