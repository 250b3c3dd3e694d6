//! The figures of the paper: each is drawn, with its axes, units and the points of the experiment.

#[path = "../../examples/paper_figures/figures/mod.rs"]
mod figures;

use bounce_audio::plot;

#[test]
fn every_figure_has_its_axes_with_units_and_the_experiments_point() {
    let expected: [&[&str]; 6] = [
        &[
            "time from release t (s)",
            "height x (mm)",
            "ΔT = 3.4 ms, by (20)",
            "first bounce",
        ],
        &["h₀ = 30.5 cm", "total time 7.5 s", "n = 70", "e = 0.9335"],
        &[
            "number of bounces n",
            "e = 0.93",
            "experiment: n = 70, 7.5 s",
        ],
        &["contact time ΔT (ms)", "eq. (28)", "video: ΔT = 1.0 ms"],
        &["k/m (s⁻²)", "eq. (26)", "10⁷", "ΔT = 3.4 ms"],
        &["c/m (s⁻¹)", "experiment: e = 0.93, ΔT = 3.4 ms"],
    ];
    let drawn = figures::all().unwrap();
    for ((name, figure), labels) in drawn.iter().zip(expected) {
        let svg = plot::to_svg(figure).unwrap();
        assert!(
            svg.starts_with("<svg ") && svg.ends_with("</svg>\n"),
            "{name}"
        );
        for label in labels {
            assert!(svg.contains(label), "{name}: '{label}' is missing");
        }
        assert!(svg.matches("<polyline").count() > 10, "{name} is empty");
    }
}

#[test]
fn a_figure_is_a_png_too() {
    let (_, figure) = &figures::all().unwrap()[5];
    let bytes = plot::to_png(figure).unwrap();
    assert!(bytes.starts_with(b"\x89PNG") && bytes.len() > 10_000);
}
