//! A constant that one run of the program may change. The ablation puts this file into its copy of the source, where every
//! constant asks here for its value.

/// The variable of the environment that names the number to change and how: `file.rs::NAME=half`, `=double` or a value.
const VARIABLE: &str = "BOUNCE_AUDIO_ABLATION";

/// A number, or a pair or an array of them.
pub(crate) trait Tuned: Copy {
    /// The number, changed by a rule.
    fn changed(self, change: &Change) -> Self;
}

/// How a number is changed.
#[derive(Debug)]
pub(crate) struct Change {
    how: String,
    named_for_unit: bool,
}

/// The number of a key as this run of the program has it.
pub(crate) fn tuned<T: Tuned>(key: &str, value: T) -> T {
    let asked = std::env::var(VARIABLE).unwrap_or_default();
    let Some((_, how)) = asked.split_once('=').filter(|(of, _)| *of == key) else {
        return value;
    };
    // `file.rs::NAME`, with an element or field after another dot.
    let name = key.rsplit("::").next().and_then(|name| name.split('.').next());
    let units = ["_S", "_HZ", "_M", "_DB", "_S2"];
    value.changed(&Change {
        how: how.to_owned(),
        named_for_unit: name.is_some_and(|name| units.iter().any(|unit| name.ends_with(unit))),
    })
}

impl Change {
    /// A number near 1 that has no unit is a share or a ratio: its distance from 1 is what is halved and doubled.
    fn of(&self, x: f64) -> f64 {
        let origin = if !self.named_for_unit && (x - 1.0).abs() < 0.5 && x != 1.0 {
            1.0
        } else {
            0.0
        };
        match self.how.as_str() {
            "half" => origin + 0.5 * (x - origin),
            "double" => origin + 2.0 * (x - origin),
            value => value.parse().unwrap_or(x),
        }
    }
}

impl Tuned for f64 {
    fn changed(self, change: &Change) -> Self {
        change.of(self)
    }
}

impl Tuned for f32 {
    fn changed(self, change: &Change) -> Self {
        change.of(f64::from(self)) as f32
    }
}

macro_rules! whole {
    ($($type:ty),*) => {$(
        impl Tuned for $type {
            fn changed(self, change: &Change) -> Self {
                match change.how.as_str() {
                    "half" => self / 2,
                    "double" => self * 2,
                    value => value.parse::<f64>().map_or(self, |x| x as Self),
                }
            }
        }
    )*};
}
whole!(usize, u32, u64, i32);

impl<A: Tuned, B: Tuned> Tuned for (A, B) {
    fn changed(self, change: &Change) -> Self {
        (self.0.changed(change), self.1.changed(change))
    }
}

impl<T: Tuned, const N: usize> Tuned for [T; N] {
    fn changed(self, change: &Change) -> Self {
        self.map(|x| x.changed(change))
    }
}
