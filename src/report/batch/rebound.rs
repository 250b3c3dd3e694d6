//! What the first rebounds of drops from known heights say together.

use super::super::numbers::{counted, decimals};
use super::super::wrap::wrapped;
use super::DropDigest;
use crate::fit::random_effects::{Measurement, RandomEffects};

/// Mean resilience of two drops or more, their spread, and that which their errors claim.
pub(super) fn described<'a>(drops: impl Iterator<Item = &'a DropDigest>) -> String {
    let measured: Vec<Measurement> = drops.filter_map(|drop| drop.resilience).collect();
    let Some(pooled) = RandomEffects::of(&measured) else {
        return String::new();
    };
    // A height, a contact or a drag that is off is off for all: no number of drops makes that smaller.
    let percent = [
        pooled.mean,
        pooled.mean_std.max(least(&measured)),
        pooled.spread,
        pooled.claimed,
    ];
    let percent = percent.map(|share| 100.0 * share);
    let digits = decimals(percent[1].min(percent[2]).max(1e-6)).max(1);
    let [mean, std, spread, claimed] = percent.map(|p| format!("{p:.digits$}"));
    let said = format!(
        "  rebound  {mean} ± {std} % of the height, mean of {}; spread {spread} % between drops, where the errors of each claim \
         {claimed} %, which they may have in common",
        counted(pooled.count, "drop")
    );
    wrapped(&said, 11) + "\n"
}

/// The smallest error that one drop claims.
fn least(measured: &[Measurement]) -> f64 {
    measured
        .iter()
        .map(|(_, std)| *std)
        .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rebounds_have_a_mean_a_spread_and_an_error_that_drops_do_not_shrink() {
        let drop = |share: f64| DropDigest {
            resilience: Some((share, 0.003)),
            ..DropDigest::default()
        };
        let drops = [0.55, 0.56, 0.57, 0.56].map(drop);
        let said = described(drops.iter()).replace("\n          ", "");
        assert!(
            said.starts_with("  rebound  56.00 ± 0.41 % of the height, mean of 4 drops"),
            "{said}"
        );
        assert!(
            said.contains("spread 0.82 % between drops, where the errors of each claim 0.30 %"),
            "{said}"
        );
        let alike = [0.56; 9].map(drop);
        assert!(
            described(alike.iter()).contains("56.00000"),
            "{}",
            described(alike.iter())
        );
        assert!(described(alike[..1].iter()).is_empty());
    }
}
