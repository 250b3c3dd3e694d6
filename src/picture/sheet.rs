//! One drop on one sheet: its level over time, a few onsets, its flights, e and heights.

use super::bounces::Bounces;
use super::sound::Sound;
use super::{level, onsets, printable};
use crate::plot::{Figure, Row};
use crate::report::{Drop, Report, Warning, model_name, with_error};

/// Width and height in pixels; without a drop there is only the level.
const SIZE: (u32, u32) = (1400, 1560);
const LEVEL_ONLY: (u32, u32) = (1400, 620);
const TIMES_ONLY: (u32, u32) = (1400, 1000);
/// Texts and lines of a sheet against those of a picture with one panel.
const DENSITY: f64 = 0.8;

/// The sheets of a report: one for each drop, or one that shows why there is none. `sounds` is what
/// [`Sound::of`] made of the same report, after it heard the recording.
#[must_use]
pub fn sheets(report: &Report, sounds: &[Sound]) -> Vec<Figure> {
    let drops = &report.drops;
    if drops.is_empty() {
        return sounds.iter().map(|s| without_drop(report, s)).collect();
    }
    let numbered = drops.iter().zip(sounds).enumerate();
    numbered
        .map(|(i, (drop, sound))| {
            let of = (drops.len() > 1).then(|| format!(", drop {} of {}", i + 1, drops.len()));
            sheet(report, drop, sound, &of.unwrap_or_default())
        })
        .collect()
}

fn sheet(report: &Report, drop: &Drop, sound: &Sound, which: &str) -> Figure {
    let bounces = Bounces::of(drop, report.settings.gravity_m_per_s2);
    let rows = [
        (30, vec![level::panel(report, Some(drop), sound)]),
        (24, onsets::panels(drop, &sound.onsets)),
        (34, vec![bounces.flights(), bounces.restitutions()]),
        (27, vec![bounces.residuals(), bounces.heights()]),
    ];
    let rows = rows.into_iter().filter(|(_, panels)| !panels.is_empty());
    Figure {
        title: format!("{}{which}", printable(&report.file)),
        subtitle: Some(answer(drop)),
        rows: rows
            .map(|(height, panels)| Row { height, panels })
            .collect(),
        size: SIZE,
        density: DENSITY,
    }
}

/// The sheets of drops whose times were typed in: what does not need their sound.
#[must_use]
pub fn sheets_of_times(report: &Report) -> Vec<Figure> {
    let drops = report.drops.iter().enumerate();
    let several = report.drops.len() > 1;
    drops
        .map(|(i, drop)| {
            let bounces = Bounces::of(drop, report.settings.gravity_m_per_s2);
            let which = several.then(|| format!(", drop {} of {}", i + 1, report.drops.len()));
            let rows = [
                vec![bounces.flights(), bounces.restitutions()],
                vec![bounces.residuals(), bounces.heights()],
            ];
            Figure {
                title: format!("{}{}", printable(&report.file), which.unwrap_or_default()),
                subtitle: Some(answer(drop)),
                rows: rows.map(|panels| Row { height: 1, panels }).to_vec(),
                size: TIMES_ONLY,
                density: DENSITY,
            }
        })
        .collect()
}

/// e with its error, the number of impacts, and the model.
fn answer(drop: &Drop) -> String {
    let e = drop.restitution.as_ref().map_or_else(
        || "e not determined".to_owned(),
        |r| format!("e = {}", with_error(&r.estimate)),
    );
    let model = model_name(&drop.model);
    format!("{e}, {} bounces heard, model: {model}", drop.bounces)
}

fn without_drop(report: &Report, sound: &Sound) -> Figure {
    Figure {
        title: format!("{}: no drop found", printable(&report.file)),
        subtitle: report.warnings.first().map(first_sentence),
        rows: vec![Row {
            height: 1,
            panels: vec![level::panel(report, None, sound)],
        }],
        size: LEVEL_ONLY,
        density: DENSITY,
    }
}

/// The first sentence of a warning: there is room for one line.
fn first_sentence(warning: &Warning) -> String {
    let sentence = warning.message.split(". ").next();
    sentence.unwrap_or_default().to_owned()
}
