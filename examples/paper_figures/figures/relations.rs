//! Figures 4 to 7: how the numbers of a ball hang together.

use bounce_audio::Error;
use bounce_audio::physics::{Ball, Oscillator, Restitution};
use bounce_audio::picture::{self, total_time::Point};
use bounce_audio::plot::{Axis, Colour, Curve, Figure, Layer, Panel, Side, Stroke};

use super::{
    BOUNCES, CONTACT_BY_EQ20_S, CONTACT_BY_VIDEO_S, GRAVITY_M_PER_S2, HEIGHT_M, RESTITUTION,
    TOTAL_TIME_S, curve, dot, named, note, series, spread,
};

/// Figure 4: `T_total` against n by (25).
pub(super) fn total_time() -> Result<Figure, Error> {
    let point = Point {
        bounces: BOUNCES as usize,
        total_time_s: TOTAL_TIME_S,
        total_time_std_s: None,
        restitution: None,
        name: "experiment: n = 70, 7.5 s".to_owned(),
    };
    let title = "Fig. 4  Total time by eq. (25), h₀ = 30.5 cm";
    picture::total_time::figure(HEIGHT_M, GRAVITY_M_PER_S2, &point, title)
}

/// Figure 5: ΔT against n by (20) and (28).
pub(super) fn contact_time() -> Result<Figure, Error> {
    let series = series()?;
    let mut panel = Panel::new(
        Axis::linear("number of bounces n", 0.0, 100.0),
        Axis::logarithmic("contact time ΔT (ms)", 0.01, 1e4),
    );
    for (e, colour) in [0.80, 0.85, 0.90, 0.93, 0.95]
        .into_iter()
        .zip(Colour::FAMILY)
    {
        let restitution = Restitution::new(e)?;
        let (mut exact, mut lively) = (Vec::new(), Vec::new());
        for n in 1..=100_u32 {
            let (x, n) = (f64::from(n), n as usize);
            exact.push((x, 1e3 * series.rest_contact_time_s(restitution, n)?));
            lively.push((x, 1e3 * series.rest_contact_time_approx_s(restitution, n)?));
        }
        let name = format!("e = {e:.2}, eq. (20)");
        panel = panel.with(named(exact, colour, Stroke::Broad, &name));
        panel = panel.with(Layer::Curve(
            Curve::new(lively, Colour::BLACK).stroke(Stroke::Dashed),
        ));
    }
    let key = vec![(0.0, 0.0); 2];
    panel = panel.with(named(
        key,
        Colour::BLACK,
        Stroke::Dashed,
        "the same, eq. (28)",
    ));
    let n = f64::from(BOUNCES);
    panel = panel
        .with(dot(
            (n, 1e3 * CONTACT_BY_EQ20_S),
            false,
            "experiment: n = 70, ΔT = 3.4 ms",
        ))
        .with(dot(
            (n, 1e3 * CONTACT_BY_VIDEO_S),
            true,
            "video: ΔT = 1.0 ms",
        ));
    Ok(Figure::new(
        "Fig. 5  Contact time by eqs. (20) and (28), h₀ = 30.5 cm",
        vec![panel],
    ))
}

/// The contact times of Figures 6 and 7, in ms.
const CONTACT_TIMES_MS: [f64; 5] = [1.0, 2.0, 3.4, 5.0, 10.0];

/// The ball's numbers at the two contact times of the paper.
fn measured(number: fn(&Oscillator) -> f64) -> Result<[Layer; 2], Error> {
    let e = Restitution::new(RESTITUTION)?;
    let at = |contact_s: f64| -> Result<(f64, f64), Error> {
        Ok((
            RESTITUTION,
            number(&Oscillator::from_contact(e, contact_s)?),
        ))
    };
    Ok([
        dot(
            at(CONTACT_BY_EQ20_S)?,
            false,
            "experiment: e = 0.93, ΔT = 3.4 ms",
        ),
        dot(at(CONTACT_BY_VIDEO_S)?, true, "video: ΔT = 1.0 ms"),
    ])
}

/// A number of the ball against e, from 0.40 to 0.95, at one contact time.
fn against_restitution(
    contact_s: f64,
    number: fn(&Oscillator) -> f64,
) -> Result<Vec<(f64, f64)>, Error> {
    spread(0.40, 0.95, 110)
        .map(|e| {
            let ball = Oscillator::from_contact(Restitution::new(e)?, contact_s)?;
            Ok((e, number(&ball)))
        })
        .collect()
}

/// Figure 6: k/m against e by (14) and (26).
pub(super) fn stiffness() -> Result<Figure, Error> {
    let mut panel = Panel::new(
        Axis::linear("coefficient of restitution e", 0.40, 0.96),
        Axis::logarithmic("stiffness per mass k/m (s⁻²)", 5e4, 2e8),
    );
    for (contact_ms, colour) in CONTACT_TIMES_MS.into_iter().zip(Colour::FAMILY) {
        let contact_s = 1e-3 * contact_ms;
        let exact = against_restitution(contact_s, Oscillator::stiffness_per_mass_per_s2)?;
        let lively = Ball::stiffness_approx_n_per_m(1.0, contact_s)?;
        let label = note(
            (0.5, lively),
            Side::Above,
            format!("ΔT = {contact_ms} ms"),
            colour,
        );
        let dashed = Curve::new(vec![(0.40, lively), (0.95, lively)], Colour::BLACK);
        panel = panel
            .with(Layer::Curve(
                Curve::new(exact, colour).stroke(Stroke::Broad),
            ))
            .with(Layer::Curve(dashed.stroke(Stroke::Dashed)))
            .with(label);
    }
    let key = vec![(0.0, 0.0); 2];
    panel = panel
        .with(named(key.clone(), Colour::GREY, Stroke::Broad, "eq. (14)"))
        .with(named(key, Colour::BLACK, Stroke::Dashed, "eq. (26)"));
    for layer in measured(Oscillator::stiffness_per_mass_per_s2)? {
        panel = panel.with(layer);
    }
    Ok(Figure::new(
        "Fig. 6  Stiffness per mass by eqs. (14) and (26)",
        vec![panel],
    ))
}

/// Figure 7: c/m against e by (15).
pub(super) fn damping() -> Result<Figure, Error> {
    let mut panel = Panel::new(
        Axis::linear("coefficient of restitution e", 0.40, 0.96),
        Axis::logarithmic("damping per mass c/m (s⁻¹)", 8.0, 3000.0),
    );
    for (contact_ms, colour) in CONTACT_TIMES_MS.into_iter().zip(Colour::FAMILY) {
        let points = against_restitution(1e-3 * contact_ms, Oscillator::damping_per_mass_per_s)?;
        let at = points.get(20).copied().unwrap_or_default();
        panel = panel.with(curve(points, colour)).with(note(
            at,
            Side::Above,
            format!("ΔT = {contact_ms} ms"),
            colour,
        ));
    }
    for layer in measured(Oscillator::damping_per_mass_per_s)? {
        panel = panel.with(layer);
    }
    Ok(Figure::new(
        "Fig. 7  Damping per mass by eq. (15)",
        vec![panel],
    ))
}
