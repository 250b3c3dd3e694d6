//! What came of the drops of a cell.

use bounce_audio::fit::ModelKind;
use bounce_audio::fit::model_selection::{Choice, Inputs, Selection, select};
use bounce_audio::physics::{BallModel, Restitution};
use bounce_audio::random::SplitMix64;

use crate::cell::Cell;
use crate::{ALIKE, GRAVITY};

/// What came of the drops of a cell.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    pub(crate) drops: usize,
    pub(crate) held: usize,
    pub(crate) squares: f64,
    pub(crate) variances: f64,
    pub(crate) contact_held: usize,
    pub(crate) auto_drops: usize,
    pub(crate) auto_held: usize,
    pub(crate) auto_right: usize,
}

impl Tally {
    pub(crate) fn of(cell: &Cell, drops: usize, seed: u64) -> Self {
        let mut rng = SplitMix64::new(seed);
        let mut tally = Self::default();
        let inputs = Inputs::default();
        for i in 0..drops {
            let Some((impacts, ball)) = cell.drop(&mut rng) else {
                continue;
            };
            tally.drops += 1;
            if let Some(selection) = select(&impacts, &[], &inputs, cell.ball.choice()) {
                tally.add(&selection, cell, truth(&ball, &selection));
            }
            if i % 10 == 0 {
                tally.auto_drops += 1;
                if let Some(auto) = select(&impacts, &[], &inputs, Choice::Auto) {
                    tally.auto_held += usize::from(holds(&auto, truth(&ball, &auto)));
                    tally.auto_right += usize::from(is_right(&auto, cell.ball.kind()));
                }
            }
        }
        tally
    }

    fn add(&mut self, selection: &Selection, cell: &Cell, ln_e: f64) {
        let fitted = selection.fit.ln_restitution;
        self.held += usize::from(holds(selection, ln_e));
        self.squares += (fitted.value - ln_e).powi(2);
        self.variances += fitted.std.unwrap_or(0.0).powi(2);
        let ends = selection.fit.contact_s.and_then(|c| c.interval95);
        if let (Some([low, high]), Some(contact_s)) = (ends, cell.ball.contact_s()) {
            self.contact_held += usize::from(low <= contact_s && contact_s <= high);
        }
    }
}

/// ln e of the ball at the speed where it is stated.
fn truth(ball: &BallModel, selection: &Selection) -> f64 {
    let at_speed = 0.5 * GRAVITY * selection.fit.mean_speed_s;
    ball.restitution(at_speed).map_or(f64::NAN, Restitution::ln)
}

fn holds(selection: &Selection, ln_e: f64) -> bool {
    let ends = selection.fit.ln_restitution.interval95;
    ends.is_some_and(|[low, high]| low <= ln_e && ln_e <= high)
}

/// Whether this model was taken, or one that cannot be told from it.
fn is_right(selection: &Selection, kind: ModelKind) -> bool {
    let gain = |kind: ModelKind| {
        let found = selection.candidates.iter().find(|c| c.model == kind);
        found.map_or(f64::NEG_INFINITY, |c| c.gain_nats)
    };
    selection.selected == kind || gain(selection.selected) - gain(kind) < ALIKE
}
