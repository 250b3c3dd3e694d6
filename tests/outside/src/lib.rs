//! Everything that the library promises, by its name and its type. Whoever changes a line here breaks programs elsewhere.

/// What a core without features promises.
pub mod core {
    use bounce_audio::physics::{Ball, BounceSeries, Oscillator, Restitution};
    use bounce_audio::report;
    use bounce_audio::{
        Analysis, Drop, Error, Listener, ModelChoice, Report, Settings, Timing, Warning,
        WarningCode, analyze, analyze_clearest,
    };

    pub type Heard = Result<(usize, Analysis), Error>;
    pub type Numbers = (Ball, BounceSeries, Oscillator, Restitution);
    pub const CODE: fn(&Warning) -> WarningCode = |warning| warning.code;
    pub const VERSION: u32 = report::SCHEMA_VERSION;
    pub const ANALYZE: fn(&[f32], f64, &Settings) -> Result<Analysis, Error> = analyze;
    pub const ANALYZE_CLEAREST: fn(&[Vec<f32>], f64, &Settings) -> Heard = analyze_clearest;
    pub const LISTENER: fn(usize, f64, &Settings) -> Result<Listener, Error> = Listener::new;
    pub const PUSH: fn(&mut Listener, &[Vec<f32>]) -> Result<(), Error> = Listener::push;
    pub const FINISH: fn(Listener) -> Heard = Listener::finish;
    pub const CHECK: fn(&Settings) -> Result<(), Error> = Settings::check;
    pub const TEXT: fn(&Report, report::text::Detail) -> String = report::text::to_text;
    pub const TEXT_WITH: fn(&Report, report::text::Detail, report::text::Advice<'_>) -> String =
        report::text::to_text_with;
    pub const CSV: fn(&Report) -> String = report::csv::to_csv;
    pub const MODELS: [ModelChoice; 7] = [
        ModelChoice::Auto,
        ModelChoice::Constant,
        ModelChoice::Contact,
        ModelChoice::Linear,
        ModelChoice::Drag,
        ModelChoice::Speed,
        ModelChoice::Viscoelastic,
    ];
    pub const TIMINGS: [Timing; 3] = [Timing::Envelope, Timing::Fraction, Timing::Correlation];

    /// Every setting.
    #[must_use]
    pub fn settings() -> Settings {
        Settings::default()
            .height_m(0.3)
            .height_std_m(1e-3)
            .gravity_m_per_s2(9.81)
            .mass_kg(2.5e-3)
            .diameter_m(Some(38e-3))
            .contact_time_s(None)
            .model(ModelChoice::Auto)
            .start_s(0.0)
            .end_s(4.0)
            .timing(Timing::Correlation)
    }

    /// What is read of a drop, most of all.
    #[must_use]
    pub fn words(analysis: &Analysis) -> Vec<String> {
        let drop = |drop: &Drop| {
            let e = drop.restitution.as_ref().map(|r| r.estimate.value);
            let last_s = drop.impacts.last().map(|impact| impact.time_s);
            format!("{} impacts, e {e:?}, last at {last_s:?} s", drop.bounces)
        };
        let warning = |warning: &Warning| warning.message.clone();
        let drops = analysis.drops.iter().map(drop);
        drops.chain(analysis.warnings.iter().map(warning)).collect()
    }
}

/// What `audio` adds.
#[cfg(feature = "audio")]
pub mod audio {
    use bounce_audio::audio::{Recording, Stream, read, read_file};
    use bounce_audio::recording::{Channel, listen};
    use bounce_audio::report::Report;
    use bounce_audio::{Error, Settings};
    use std::path::Path;

    pub const LISTEN: fn(Stream<'_>, &str, Channel, &Settings) -> Result<Report, Error> = listen;
    pub const OPEN: fn(&Path) -> Result<Stream<'static>, Error> = Stream::open_file;
    pub const READ: fn(&'static [u8]) -> Result<Recording, Error> = read;
    pub const READ_FILE: fn(&Path) -> Result<Recording, Error> = read_file;
    pub const CHANNELS: [Channel; 2] = [Channel::Best, Channel::Number(1)];
}

/// What `lab` adds.
#[cfg(feature = "lab")]
pub mod lab {
    use bounce_audio::Error;
    use bounce_audio::synth::scene::Scene;
    use bounce_audio::synth::{Synthetic, presets::preset, render};

    pub const RENDER: fn(&Scene, u64) -> Result<Synthetic, Error> = render;
    pub const PRESET: fn(&str) -> Result<Scene, Error> = preset;
    pub const SCENE: fn(&str) -> Result<Scene, Error> = Scene::from_toml;
}

/// What `plots` adds.
#[cfg(feature = "plots")]
pub mod plots {
    use bounce_audio::Error;
    use bounce_audio::picture::sheet::sheets;
    use bounce_audio::picture::sound::Sound;
    use bounce_audio::picture::{Figure, to_png, to_svg};
    use bounce_audio::report::Report;

    pub const SOUNDS: fn(&Report) -> Vec<Sound> = Sound::of;
    pub const SHEETS: fn(&Report, &[Sound]) -> Vec<Figure> = sheets;
    pub const SVG: fn(&Figure) -> Result<String, Error> = to_svg;
    pub const PNG: fn(&Figure) -> Result<Vec<u8>, Error> = to_png;
}

/// What `cli` adds.
#[cfg(feature = "cli")]
pub mod cli {
    use bounce_audio::Error;
    use bounce_audio::cli::{Outcome, run};

    pub const RUN: fn() -> Result<Outcome, Error> = run;
}
