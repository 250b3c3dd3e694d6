//! Pictures: what a figure holds is in the SVG, and the PNG has ink.

use bounce_audio::plot::{
    Axis, Colour, Curve, Dots, Figure, Layer, Note, Panel, Shape, Side, Stroke, to_png, to_svg,
};

fn figure() -> Figure {
    let line = vec![(0.0, 1.0), (10.0, 1000.0)];
    let x = Axis::linear("time t (s)", 0.0, 10.0);
    let y = Axis::logarithmic("stiffness k/m (s⁻²)", 1.0, 1000.0);
    let dots = Dots::new(vec![(5.0, 30.0)], Shape::Ring, Colour::BLACK).named("measured");
    let note = Note {
        at: (2.0, 10.0),
        side: Side::Right,
        text: "a < b & ζ".to_owned(),
        colour: Colour::GREY,
    };
    let panel = Panel::new(x, y)
        .with(Layer::Curve(
            Curve::new(line.clone(), Colour::BLUE).named("e = 0.93"),
        ))
        .with(Layer::Curve(
            Curve::new(line, Colour::RED)
                .stroke(Stroke::Dashed)
                .named("approximate"),
        ))
        .with(Layer::Dots(dots))
        .with(Layer::Note(note))
        .with(Layer::Span {
            from: (1.0, 2.0),
            to: (9.0, 2.0),
        });
    Figure::new("A figure", vec![panel])
}

#[test]
fn svg_says_all_that_the_figure_holds() {
    let svg = to_svg(&figure()).unwrap();
    for part in [
        "<svg ",
        "A figure",
        "time t (s)",
        "stiffness k/m (s⁻²)",
        "e = 0.93",
        "approximate",
        "measured",
        "a &lt; b &amp; ζ",
        "sans-serif",
        "</svg>",
    ] {
        assert!(svg.contains(part), "{part} is missing");
    }
    assert_eq!(svg.matches("<text").count(), svg.matches("</text>").count());
}

#[test]
fn an_svg_brings_its_own_ground() {
    let svg = to_svg(&figure()).unwrap();
    let (_, behind) = svg.split_once("viewBox=\"0 0 ").unwrap();
    let (size, _) = behind.split_once('"').unwrap();
    let (width, height) = size.split_once(' ').unwrap();
    let ground = format!(
        "<rect x=\"0\" y=\"0\" width=\"{width}\" height=\"{height}\" opacity=\"1\" fill=\"#FFFFFF\""
    );
    let first = svg.split('\n').nth(1).unwrap();
    assert!(first.starts_with(&ground), "{first}");
}

#[test]
fn png_has_its_size_and_some_ink() {
    let bytes = to_png(&figure()).unwrap();
    let decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!((info.width, info.height), (1400, 900));
    assert_eq!(
        info.color_type,
        png::ColorType::Rgb,
        "nothing shines through"
    );
    assert!(pixels.iter().filter(|&&value| value < 64).count() > 10_000);
}

#[test]
fn an_axis_without_extent_is_an_error() {
    let axis = Axis::linear("time", 1.0, 1.0);
    let empty = Figure::new("", vec![Panel::new(axis.clone(), axis)]);
    assert!(to_svg(&empty).unwrap_err().to_string().contains("time"));
}
