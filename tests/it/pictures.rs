//! Sheets of analyses and of batches: everything is on them once, readable, whatever a report lacks.

use bounce_audio::picture::batch::{self, BatchRow, Order, Ranged};
use bounce_audio::picture::sheet::sheets;
use bounce_audio::picture::sound::Sound;
use bounce_audio::picture::total_time::{self, Point};
use bounce_audio::plot::{Figure, to_png, to_svg};
use bounce_audio::report::{RecordingInfo, Report, Status};
use bounce_audio::{Settings, analyze};

const RATE: f64 = 8_000.0;

/// Clicks of a ball: first flight, e, number of impacts; from half a second on, in eight seconds.
fn clicks(first_flight_s: f64, e: f64, impacts: u32) -> Vec<f32> {
    let mut samples = vec![0.0_f32; 64_000];
    let (mut at_s, mut flight_s, mut size) = (0.5, first_flight_s, 0.8);
    for _ in 0..impacts {
        for k in 0..8_u8 {
            let sign = if k % 2 == 0 { size } else { -size };
            samples[bounce_audio::units::samples_in(at_s, RATE) + usize::from(k)] +=
                sign / f32::from(k + 1);
        }
        at_s += flight_s;
        flight_s *= e;
        size *= 0.97;
    }
    samples
}

fn report(samples: &[f32]) -> Report {
    let settings = Settings::default();
    let recording = RecordingInfo::new(RATE, 8.0, "made here");
    let analysis = analyze(samples, RATE, &settings).unwrap();
    Report::new("clicks.wav".to_owned(), recording, settings, analysis, None)
}

/// The sheets of a report on these samples, heard in blocks.
fn drawn(report: &Report, samples: &[f32]) -> Vec<Figure> {
    let mut sounds = Sound::of(report);
    for sound in &mut sounds {
        for (i, block) in samples.chunks(1_000).enumerate() {
            sound.hear(1_000 * i, block);
        }
    }
    sheets(report, &sounds)
}

/// The only sheet as SVG, after what holds of every picture was checked.
fn svg(figures: &[Figure]) -> String {
    assert_eq!(figures.len(), 1);
    let svg = to_svg(&figures[0]).unwrap();
    assert!(!svg.contains("NaN") && !svg.contains("inf<") && !svg.contains("\"inf"));
    assert_no_texts_touch(&svg);
    svg
}

/// A text of an SVG: what it says, and left, top, right and bottom.
type Framed = (String, [f64; 4]);

fn attribute<'a>(tag: &'a str, name: &str) -> &'a str {
    let start = tag.find(&format!(" {name}=\"")).unwrap() + name.len() + 3;
    &tag[start..start + tag[start..].find('"').unwrap()]
}

/// Upright texts with the room that they take in the bundled font, whose characters are 0.6 of its size wide at most on
/// the average of a text.
fn texts(svg: &str) -> Vec<Framed> {
    let parts = svg.split("<text").skip(1);
    let upright = parts.filter(|p| !p.split('>').next().unwrap().contains("rotate"));
    let framed = upright.map(|part| {
        let (tag, rest) = part.split_once('>').unwrap();
        let text = rest.split('<').next().unwrap().trim().to_owned();
        let number = |name| attribute(tag, name).parse::<f64>().unwrap();
        let size = number("font-size");
        let width = 0.6 * size * f64::from(u16::try_from(text.chars().count()).unwrap());
        let left = number("x")
            - match attribute(tag, "text-anchor") {
                "middle" => 0.5 * width,
                "end" => width,
                _ => 0.0,
            };
        let below: f64 = match tag.contains(" dy=") {
            true if attribute(tag, "dy").starts_with("0.7") => 0.76,
            true if attribute(tag, "dy").starts_with("0.5") => 0.3,
            _ => 0.0,
        };
        let foot = number("y") + below * size;
        (text, [left, foot - 0.72 * size, left + width, foot])
    });
    framed.collect()
}

fn assert_no_texts_touch(svg: &str) {
    let texts = texts(svg);
    let size = attribute(svg, "viewBox")
        .split(' ')
        .map(|n| n.parse().unwrap());
    let size: Vec<f64> = size.collect();
    for (i, (text, a)) in texts.iter().enumerate() {
        let inside = a[0] >= 0.0 && a[1] >= 0.0 && a[2] <= size[2] && a[3] <= size[3];
        assert!(inside, "'{text}' leaves the picture: {a:?}");
        for (other, b) in &texts[..i] {
            let apart = a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1];
            assert!(apart, "'{text}' touches '{other}': {a:?} {b:?}");
        }
    }
}

fn count(svg: &str, tag: &str, colour: &str) -> usize {
    let start = format!("<{tag} ");
    let tags = svg.split(start.as_str()).skip(1);
    let tags = tags.filter(|part| part.split('>').next().unwrap().contains(colour));
    tags.count()
}

const BLUE: &str = "#0072B2";

#[test]
fn a_sheet_has_a_mark_for_each_impact_and_for_all_that_follows_from_it() {
    let samples = clicks(0.5, 0.85, 20);
    let report = report(&samples);
    let drop = &report.drops[0];
    assert!(drop.impacts.iter().all(|i| i.status == Status::Heard));
    let impacts = drop.impacts.len();
    assert!(impacts >= 18, "{impacts}");
    let svg = svg(&drawn(&report, &samples));
    // Impacts; flights, what the model leaves of them, heights; e between them; the samples of two legends.
    let marks = impacts + 3 * (impacts - 1) + (impacts - 2) + 2;
    let rings = count(&svg, "circle", "fill=\"none\"");
    let beyond = svg.matches(">\noff the scale\n").count();
    let all = count(&svg, "circle", &format!("fill=\"{BLUE}\"")) + rings - beyond;
    assert_eq!(all, marks, "{rings} rings");
    for part in [
        "clicks.wav",
        "e = 0.8",
        "Level of channel 1",
        "Impact 1: 0.",
        "Flights",
        "Flights, less the model",
        "e of each bounce",
        "Rebounds g·T²/8",
        ">\n1\n",
        ">\n10\n",
    ] {
        assert!(svg.contains(part), "'{part}' is missing");
    }
}

#[test]
fn a_hundred_and_more_impacts_are_numbered_as_far_as_there_is_room() {
    let samples = clicks(0.2, 0.97, 110);
    let report = report(&samples);
    assert!(report.drops[0].impacts.len() > 90);
    let svg = svg(&drawn(&report, &samples));
    let numbers = texts(&svg);
    let numbers = numbers
        .iter()
        .filter(|(text, _)| text == "1" || text == "50");
    assert!(numbers.count() >= 2);
    assert!(svg.len() < 600_000, "{} bytes", svg.len());
}

#[test]
fn the_png_of_a_sheet_decodes_and_has_ink() {
    let samples = clicks(0.5, 0.85, 12);
    let figures = drawn(&report(&samples), &samples);
    let decoder = png::Decoder::new(std::io::Cursor::new(to_png(&figures[0]).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!((info.width, info.height), figures[0].size);
    assert!(pixels.iter().filter(|&&value| value < 64).count() > 10_000);
}

#[test]
fn without_a_drop_there_is_the_level_with_what_was_rejected() {
    let mut samples = vec![0.0_f32; 64_000];
    for at in [8_000, 20_000, 50_000] {
        samples[at] = 0.5;
    }
    let mut report = report(&samples);
    assert!(report.drops.is_empty());
    report.file = "a\u{7}<b>&.wav".to_owned();
    let svg = svg(&drawn(&report, &samples));
    assert!(
        svg.contains("a?&lt;b&gt;&amp;.wav")
            && svg.contains("no drop found")
            && svg.contains("rejected")
    );
    // Silence has no level at all.
    let silence = vec![0.0_f32; 64_000];
    report.rejected.clear();
    assert!(!self::svg(&drawn(&report, &silence)).contains("rejected"));
}

#[test]
fn three_impacts_without_any_error_make_a_sheet_too() {
    let samples = clicks(0.5, 0.8, 12);
    let mut report = report(&samples);
    let drop = &mut report.drops[0];
    drop.impacts.truncate(3);
    drop.bounces = 3;
    drop.impacts[2].interval_s = None;
    drop.impacts[2].rebound_height_m = None;
    for impact in &mut drop.impacts {
        impact.time_std_s = None;
        impact.rebound_height_std_m = None;
        impact.bounce.restitution_std = None;
    }
    drop.impacts[2].bounce.restitution = None;
    drop.scatter.bounce_std = None;
    let estimate = &mut drop.restitution.as_mut().unwrap().estimate;
    (estimate.std_error, estimate.interval95) = (None, None);
    let one = svg(&drawn(&report, &samples));
    assert!(one.contains("no error: a single ratio") && one.contains("Impact 3: "));
    // Nor does a drop need an e, or impacts that were heard.
    let drop = &mut report.drops[0];
    drop.restitution = None;
    drop.impacts[1].status = Status::Inferred;
    for impact in &mut drop.impacts {
        (impact.interval_s, impact.level_db, impact.rebound_height_m) = (None, None, None);
        impact.bounce = bounce_audio::report::Bounce::default();
    }
    let bare = svg(&drawn(&report, &samples));
    assert!(bare.contains("e not determined") && bare.contains("inferred"));
}

#[test]
fn a_long_name_is_shortened_and_each_of_several_drops_has_its_sheet() {
    let samples = clicks(0.5, 0.8, 12);
    let mut report = report(&samples);
    report.file = format!("{}end.wav", "a/long/way/".repeat(30));
    let again = report.drops[0].clone();
    report.drops.push(again);
    let figures = drawn(&report, &samples);
    assert_eq!(figures.len(), 2);
    for (figure, which) in figures.iter().zip(["drop 1 of 2", "drop 2 of 2"]) {
        let svg = svg(std::slice::from_ref(figure));
        assert!(svg.contains('…') && svg.contains(&format!("{which}: ")));
        assert!(svg.contains("of another drop"));
    }
}

fn rows(count: u32) -> Vec<BatchRow> {
    let row = |i: u32| {
        let e = 0.9 + 0.002 * f64::from(i * 7 % 11);
        let interval95 = (!i.is_multiple_of(5)).then_some([e - 0.004, e + 0.005]);
        BatchRow {
            file: format!("class of Tuesday/ball-30cm-{i:04}.wav"),
            drop: None,
            restitution: Ok(Ranged {
                value: e,
                interval95,
            }),
            outlier: i == 3,
        }
    };
    (0..count).map(row).collect()
}

const RED: &str = "#D55E00";

#[test]
fn a_batch_has_a_point_and_a_short_name_for_each_drop_and_a_histogram_of_all() {
    let figure = batch::sheet(&rows(20), Some((0.91, 0.002)), Order::File);
    let svg = svg(std::slice::from_ref(&figure));
    assert_eq!(count(&svg, "circle", BLUE), 19);
    // The outlier and its sample.
    assert_eq!(count(&svg, "circle", RED), 2);
    for part in [
        "mean e = 0.9100 ± 0.0020",
        "20 drops in 20 recordings named ball-30cm-….wav",
        ">\n0000\n",
        ">\n0019\n",
        "How often",
    ] {
        assert!(svg.contains(part), "'{part}' is missing");
    }
    // Sixteen intervals and a bar for each bin that holds something.
    assert!(count(&svg, "polygon", BLUE) > 15 + 3);
    for few in [0, 1, 2, 1_000] {
        let figure = batch::sheet(&rows(few), None, Order::Restitution);
        let svg = self::svg(&[figure]);
        let outliers = usize::from(few > 3);
        assert_eq!(count(&svg, "circle", BLUE), few as usize - outliers);
        assert_eq!(svg.contains("How often"), few == 1_000);
    }
}

#[test]
fn a_batch_shows_what_has_no_e_and_sorts_by_e() {
    let mut rows = rows(4);
    rows[1].restitution = Err("no drop".to_owned());
    rows[0].drop = Some(2);
    // Names stand from top to bottom in the order of the rows.
    let order = |order: Order| {
        let svg = svg(&[batch::sheet(&rows, None, order)]);
        assert_eq!(svg.matches("no drop").count(), 1);
        let mut names = texts(&svg);
        names.retain(|(text, _)| text.starts_with("000"));
        names.sort_by(|a, b| a.1[1].total_cmp(&b.1[1]));
        names.into_iter().map(|(text, _)| text).collect::<Vec<_>>()
    };
    assert_eq!(order(Order::File), ["0000, 2", "0001", "0002", "0003"]);
    // e is 0.900, none, 0.906, 0.920.
    assert_eq!(
        order(Order::Restitution),
        ["0003", "0002", "0000, 2", "0001"]
    );
}

#[test]
fn panels_that_a_few_bounces_cannot_fill_are_left_out() {
    let samples = clicks(0.5, 0.8, 12);
    let mut report = report(&samples);
    for (impacts, panels) in [
        (
            6,
            &["Flights", "e of each bounce", "Flights, less", "Rebounds"][..],
        ),
        (5, &["Flights", "Rebounds"]),
        (3, &[]),
    ] {
        let drop = &mut report.drops[0];
        drop.impacts.truncate(impacts);
        let last = &mut drop.impacts[impacts - 1];
        (last.interval_s, last.rebound_height_m) = (None, None);
        last.bounce.restitution = None;
        let svg = svg(&drawn(&report, &samples));
        for panel in ["Flights", "e of each bounce", "Flights, less", "Rebounds"] {
            assert_eq!(
                svg.contains(panel),
                panels.contains(&panel),
                "{impacts} {panel}"
            );
        }
        assert!(svg.contains("Level of channel") && svg.contains("Impact 1: "));
    }
}

#[test]
fn numbers_typed_in_have_their_place_among_the_curves() {
    for (bounces, total_time_s, e) in [(70, 7.5, 0.93347), (2, 0.9, 0.5), (100_000, 500.0, 0.999)] {
        let point = Point {
            bounces,
            total_time_s,
            total_time_std_s: Some(0.05),
            restitution: Some(e),
            name: "the point".to_owned(),
        };
        let figure = total_time::figure(0.305, 9.81, &point, "Total time").unwrap();
        let svg = to_svg(&figure).unwrap();
        assert!(svg.contains("the point") && svg.contains(&format!("e = {e:.4}")));
        assert!(!svg.contains("NaN"));
    }
}
