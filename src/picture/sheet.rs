//! One drop on one sheet: its level over time, a few onsets, its flights, e and heights.

use super::bounces::Bounces;
use super::sound::Sound;
use super::{level, onsets, printable};
use crate::plot::{Figure, Panel, Row};
use crate::report::{Drop, Report, Warning, heard, model_name, range, restitution};

/// Width of a sheet in pixels, and height for each share of a row, for the lines above the rows, and of all that a sheet
/// without a drop has.
const WIDTH_PX: u32 = 1400;
const SHARE_PX: u32 = 14;
const HEAD_PX: u32 = 180;
const LEVEL_ONLY_PX: u32 = 640;
/// Shares of the rows: level, onsets, and those of the two panels beside each other.
const LEVEL: u32 = 30;
const ONSETS: u32 = 26;
const PAIR: u32 = 32;

/// The sheets of a report: one for each drop, or one that shows why there is none. `sounds` is what
/// [`Sound::of`] made of the same report, after it heard the recording.
#[must_use]
pub fn sheets(report: &Report, sounds: &[Sound]) -> Vec<Figure> {
    if report.drops.is_empty() {
        return sounds.iter().map(|s| without_drop(report, s)).collect();
    }
    let drops = report.drops.iter().zip(sounds).enumerate();
    drops
        .map(|(i, (drop, sound))| {
            let level = level::panel(report, Some(drop), sound);
            let onsets = onsets::panels(drop, &sound.onsets);
            sheet(report, i, vec![(LEVEL, vec![level]), (ONSETS, onsets)])
        })
        .collect()
}

/// The sheets of drops whose times were typed in: what does not need their sound.
#[must_use]
pub fn sheets_of_times(report: &Report) -> Vec<Figure> {
    let numbers = 0..report.drops.len();
    numbers.map(|i| sheet(report, i, Vec::new())).collect()
}

/// A sheet with rows of its sound, and below them what its bounces fill, in pairs.
fn sheet(report: &Report, number: usize, mut rows: Vec<(u32, Vec<Panel>)>) -> Figure {
    let drop = &report.drops[number];
    let bounces = Bounces::of(drop, report.settings.gravity_m_per_s2).panels();
    rows.extend(bounces.chunks(2).map(|pair| (PAIR, pair.to_vec())));
    rows.retain(|(_, panels)| !panels.is_empty());
    let shares: u32 = rows.iter().map(|(height, _)| height).sum();
    let several = report.drops.len() > 1;
    let which = several.then(|| format!(", drop {} of {}", number + 1, report.drops.len()));
    let name = printable(&report.file);
    Figure {
        headline: Some(restitution(drop)),
        title: format!("{name}{}: {}", which.unwrap_or_default(), heard(drop)),
        subtitle: Some(in_words(drop)),
        rows: rows
            .into_iter()
            .map(|(height, panels)| Row { height, panels })
            .collect(),
        size: (WIDTH_PX, HEAD_PX + SHARE_PX * shares),
        density: 1.0,
    }
}

/// The interval of e, and the model that it is of.
fn in_words(drop: &Drop) -> String {
    let model = format!("model: {}", model_name(&drop.model));
    match range(drop) {
        Some(range) => format!("{range}; {model}"),
        None => model,
    }
}

fn without_drop(report: &Report, sound: &Sound) -> Figure {
    Figure {
        headline: Some("no drop found".to_owned()),
        title: printable(&report.file),
        subtitle: report.warnings.first().map(first_sentence),
        rows: vec![Row {
            height: 1,
            panels: vec![level::panel(report, None, sound)],
        }],
        size: (WIDTH_PX, LEVEL_ONLY_PX),
        density: 1.0,
    }
}

/// The first sentence of a warning: there is room for one line.
fn first_sentence(warning: &Warning) -> String {
    let sentence = warning.message.split(". ").next();
    sentence.unwrap_or_default().to_owned()
}
