//! Figures 2 and 3: how the ball moves.

use bounce_audio::Error;
use bounce_audio::physics::{
    Bounce, DropSetup, FlightLaw, Impact, LinearContact, Oscillator, Rebound, ReleaseRule,
    Restitution, RestitutionLaw,
};
use bounce_audio::plot::{Axis, Colour, Dots, Figure, Layer, Panel, Shape, Side, Stroke};

use super::{
    BOUNCES, CONTACT_BY_EQ20_S, CONTACT_BY_VIDEO_S, GRAVITY_M_PER_S2, HEIGHT_M, RESTITUTION,
    TOTAL_TIME_S, curve, named, note, series, spread,
};

/// The free flight from one moment on: times in s, heights in cm.
fn arc(start_s: f64, speed_m_per_s: f64, duration_s: f64) -> impl Iterator<Item = (f64, f64)> {
    spread(0.0, duration_s, 60).map(move |t| {
        let height_m = speed_m_per_s * t - 0.5 * GRAVITY_M_PER_S2 * t * t;
        (start_s + t, 100.0 * height_m)
    })
}

/// Height against time of a drop, through the fall and the flights after these impacts.
fn flights(impacts: &[Impact]) -> Vec<(f64, f64)> {
    let fall_s = impacts.first().map_or(0.0, |impact| impact.time_s);
    let fall =
        spread(0.0, fall_s, 60).map(|t| (t, 100.0 * (HEIGHT_M - 0.5 * GRAVITY_M_PER_S2 * t * t)));
    let hops = impacts.iter().flat_map(|impact| {
        let start = impact.time_s + impact.contact_time_s.unwrap_or(0.0);
        arc(start, impact.rebound_speed_m_per_s, impact.flight_time_s)
    });
    fall.chain(hops).collect()
}

/// The drop of the paper with this contact time, until it rests by (19).
fn drop_with(restitution: Restitution, contact_time_s: f64) -> Result<Vec<Impact>, Error> {
    let bounce = Bounce::Given {
        restitution: RestitutionLaw::Constant(restitution),
        contact_time_s,
    };
    let flight = FlightLaw::without_air(GRAVITY_M_PER_S2)?;
    Ok(DropSetup::new(HEIGHT_M, flight, bounce)
        .impacts()?
        .collect())
}

/// Figure 2: height against time, and the first contact by (3) seen closely.
pub(super) fn first_bounce() -> Result<Figure, Error> {
    let e = Restitution::new(RESTITUTION)?;
    let impacts = drop_with(e, CONTACT_BY_EQ20_S)?;
    let touch = impacts.iter().take(1).map(|impact| (impact.time_s, 0.0));
    let drop = Panel::new(
        Axis::linear("time from release t (s)", 0.0, 1.2),
        Axis::linear("height x (cm)", -5.0, 35.0),
    )
    .with(curve(vec![(0.0, 0.0), (1.2, 0.0)], Colour::GREY))
    .with(curve(flights(&impacts), Colour::BLUE))
    .with(Layer::Dots(Dots::new(
        touch.collect(),
        Shape::Disc,
        Colour::BLACK,
    )))
    .with(note(
        (0.249, 0.0),
        Side::Below,
        "first bounce",
        Colour::BLACK,
    ));

    let mut close = Panel::new(
        Axis::linear("time from first touch (ms)", -1.0, 5.0),
        Axis::linear("height x (mm)", -4.5, 3.0),
    )
    .with(curve(vec![(-1.0, 0.0), (5.0, 0.0)], Colour::GREY));
    for (contact_s, colour, name, level, side) in [
        (
            CONTACT_BY_EQ20_S,
            Colour::BLUE,
            "ΔT = 3.4 ms, by (20)",
            -2.9,
            Side::Below,
        ),
        (
            CONTACT_BY_VIDEO_S,
            Colour::RED,
            "ΔT = 1.0 ms, by video",
            0.3,
            Side::Above,
        ),
    ] {
        let (motion, duration_s) = contact_motion(Oscillator::from_contact(e, contact_s)?)?;
        let end = 1e3 * duration_s;
        close = close
            .with(named(motion, colour, Stroke::Solid, name))
            .with(Layer::Span {
                from: (0.0, level),
                to: (end, level),
            })
            .with(note((0.5 * end, level), side, "ΔT", colour));
    }
    Ok(Figure::new(
        "Fig. 2  Height and first contact by eq. (3): h₀ = 30.5 cm, e = 0.93",
        vec![drop, close],
    ))
}

/// Times in ms and heights in mm from before the first touch to after leaving, and the contact time in s.
fn contact_motion(ball: Oscillator) -> Result<(Vec<(f64, f64)>, f64), Error> {
    let contact = LinearContact::new(ball, GRAVITY_M_PER_S2, ReleaseRule::ZeroDisplacement)?;
    let speed = series()?.first_impact_speed_m_per_s();
    let (duration, rebound) = match contact.rebound(speed)? {
        Rebound::Leaves(leaving) => (leaving.contact_time_s, leaving.speed_m_per_s),
        Rebound::Stays => (0.0, 0.0),
    };
    // Over a few milliseconds of flight the ball falls straight to within a tenth of a millimetre; kept all the same.
    let free = |v: f64, t: f64| v * t - 0.5 * GRAVITY_M_PER_S2 * t * t;
    let mut points: Vec<(f64, f64)> = vec![(-1e-3, free(-speed, -1e-3))];
    for t in spread(0.0, duration, 100) {
        points.push((t, contact.position_m(speed, t)?));
    }
    points.extend(spread(0.0, 5e-3, 20).map(|t| (duration + t, free(rebound, t))));
    let scaled = points.into_iter().map(|(t, x)| (1e3 * t, 1e3 * x));
    Ok((scaled.collect(), duration))
}

/// Figure 3: the whole drop, with h0, n and `T_total`.
pub(super) fn bounce_history() -> Result<Figure, Error> {
    let series = series()?;
    let e = series
        .restitution_from_total_time(BOUNCES as usize, TOTAL_TIME_S)?
        .restitution;
    let impacts = drop_with(e, series.rest_contact_time_s(e, BOUNCES as usize)?)?;
    let mut panel = Panel::new(
        Axis::linear("time from release t (s)", -0.5, 8.0),
        Axis::linear("height x (cm)", -4.0, 36.0),
    )
    .with(curve(vec![(-0.5, 0.0), (8.0, 0.0)], Colour::GREY))
    .with(curve(flights(&impacts), Colour::BLUE))
    .with(Layer::Span {
        from: (-0.15, 0.0),
        to: (-0.15, 30.5),
    })
    .with(note(
        (0.1, 30.5),
        Side::Right,
        "h₀ = 30.5 cm",
        Colour::BLACK,
    ))
    .with(Layer::Span {
        from: (0.0, 33.0),
        to: (TOTAL_TIME_S, 33.0),
    })
    .with(note(
        (4.5, 33.0),
        Side::Above,
        "total time 7.5 s",
        Colour::BLACK,
    ));
    let last = impacts.len();
    for (number, impact) in (1..).zip(&impacts) {
        if number <= 4 || number == last {
            let at = (impact.time_s, 0.0);
            let text = if number == last {
                format!("n = {number}")
            } else {
                number.to_string()
            };
            panel = panel.with(note(at, Side::Below, text, Colour::BLACK));
        }
    }
    let title = format!(
        "Fig. 3  Bounce history: n = {last} bounces with e = {:.4} and ΔT = 4.47 ms by (25), (20)",
        e.value()
    );
    Ok(Figure::new(title, vec![panel]))
}
