//! The figures of a run over the suite, and what of them a change moved.

use bounce_audio::evaluate::rows::Row;
use bounce_audio::units::real;

/// A figure: its name, where it is in a row, and the least change that matters.
#[derive(Debug)]
pub(crate) struct Column {
    pub name: &'static str,
    pub of: fn(&Row) -> Option<f64>,
    least: Least,
}

/// The least change that matters.
#[derive(Debug)]
enum Least {
    /// One.
    Count,
    /// So much.
    Of(f64),
    /// This share of the figure.
    Share(f64),
}

pub(crate) const COLUMNS: [Column; 11] = [
    Column {
        name: "recall",
        of: |r| r.recall,
        least: Least::Of(0.001),
    },
    Column {
        name: "precision",
        of: |r| r.precision,
        least: Least::Of(0.001),
    },
    Column {
        name: "lost",
        of: |r| Some(real(r.lost_drops)),
        least: Least::Count,
    },
    Column {
        name: "false",
        of: |r| Some(real(r.false_drops)),
        least: Least::Count,
    },
    Column {
        name: "split",
        of: |r| Some(real(r.split_drops)),
        least: Least::Count,
    },
    Column {
        name: "median",
        of: |r| r.timing_error_median_s,
        least: Least::Share(0.03),
    },
    Column {
        name: "p95",
        of: |r| r.timing_error_p95_s,
        least: Least::Share(0.05),
    },
    Column {
        name: "error/stated",
        of: |r| r.error_over_stated,
        least: Least::Share(0.05),
    },
    Column {
        name: "e median",
        of: |r| r.restitution_error_median,
        least: Least::Share(0.05),
    },
    Column {
        name: "e p90",
        of: |r| r.restitution_error_p90,
        least: Least::Share(0.05),
    },
    Column {
        name: "cover",
        of: |r| r.coverage95,
        least: Least::Of(0.015),
    },
];

/// What one run gave.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Figures {
    /// A number for each recording that changes with anything in its report.
    pub documents: Vec<u64>,
    /// Thresholds of the suite that are missed.
    pub missed: usize,
    /// Time of the processor, in seconds; 0 where it is not known.
    pub cpu_s: f64,
    /// The figures over all recordings.
    pub all: Vec<f64>,
    /// The same over scenes drawn with replacement, as often as they were drawn.
    pub drawn: Vec<Vec<f64>>,
}

impl Figures {
    pub(crate) fn to_text(&self) -> String {
        let documents: Vec<String> = self.documents.iter().map(u64::to_string).collect();
        let line = |values: &[f64]| {
            let words: Vec<String> = values.iter().map(f64::to_string).collect();
            words.join(" ") + "\n"
        };
        let mut text = format!("{}\n{} {}\n", documents.join(" "), self.missed, self.cpu_s);
        text += &line(&self.all);
        text.extend(self.drawn.iter().map(|values| line(values)));
        text
    }

    /// None if the text is not that of figures.
    pub(crate) fn from_text(text: &str) -> Option<Self> {
        let mut lines = text.lines();
        let documents = lines.next()?.split(' ').map(str::parse);
        let (missed, cpu_s) = lines.next()?.split_once(' ')?;
        let mut rows = lines.map(|line| {
            let numbers = line.split(' ').map(str::parse);
            numbers.collect::<Result<Vec<f64>, _>>().ok()
        });
        Some(Self {
            documents: documents.collect::<Result<_, _>>().ok()?,
            missed: missed.parse().ok()?,
            cpu_s: cpu_s.parse().ok()?,
            all: rows.next()??,
            drawn: rows.collect::<Option<_>>()?,
        })
    }

    /// How many recordings have another report than in the run without a change.
    pub(crate) fn touched(&self, base: &Self) -> usize {
        let pairs = self.documents.iter().zip(&base.documents);
        pairs.filter(|(a, b)| a != b).count()
    }

    /// Figures that a change moved by more than matters and, but for counts, by more than two standard errors, in words.
    ///
    /// The standard error is that of the difference over scenes drawn with replacement, the same for both runs.
    pub(crate) fn moved(&self, base: &Self) -> Vec<String> {
        let moved = COLUMNS.iter().enumerate().filter_map(|(i, column)| {
            let (new, old) = (self.all[i], base.all[i]);
            let differences = self.drawn.iter().zip(&base.drawn).map(|(n, o)| n[i] - o[i]);
            let finite: Vec<f64> = differences.filter(|d| d.is_finite()).collect();
            let noise = 2.0 * spread(&finite);
            let least = match column.least {
                Least::Count => 0.5,
                Least::Of(least) => noise.max(least),
                Least::Share(share) => noise.max(share * old),
            };
            let moves = (new - old).abs() > least;
            moves.then(|| column.words(old, new))
        });
        moved.collect()
    }
}

impl Column {
    /// The figure, times in microseconds.
    pub(crate) fn shown(&self, value: f64) -> String {
        match self.name {
            "median" | "p95" => format!("{:.3} µs", 1e6 * value),
            "e median" | "e p90" => format!("{value:.5}"),
            _ => format!("{value:.4}"),
        }
    }

    fn words(&self, old: f64, new: f64) -> String {
        let name = self.name;
        match self.least {
            _ if !new.is_finite() => format!("{name} lost"),
            Least::Share(_) => format!("{name} ×{:.2}", new / old),
            Least::Count => format!("{name} {:+}", new - old),
            Least::Of(_) => format!("{name} {:+.3}", new - old),
        }
    }
}

fn spread(values: &[f64]) -> f64 {
    let count = real(values.len());
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
    if values.is_empty() {
        0.0
    } else {
        (squares / count).sqrt()
    }
}
