use bounce_audio::{detect, sequence, wav};
fn main() {
    for f in std::env::args().skip(1) {
        let r = wav::read_file(std::path::Path::new(&f)).unwrap();
        let rate = f64::from(r.sample_rate_hz);
        let t0 = std::time::Instant::now();
        let ch = (0..r.channels.len())
            .map(|c| {
                (
                    c,
                    detect::clarity(
                        &detect::candidates(&r.channels[c], rate, &detect::Settings::default())
                            .unwrap(),
                    ),
                )
            })
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap()
            .0;
        let c = detect::candidates(&r.channels[ch], rate, &detect::Settings::default()).unwrap();
        let t1 = std::time::Instant::now();
        let ev: Vec<_> = c
            .iter()
            .map(|c| sequence::Event {
                time_s: c.time_s,
                strength: c.strength, jitter_s: c.jitter_s,
            })
            .collect();
        let found = sequence::find(&ev, &sequence::Settings::default()).unwrap();
        if let Ok(w) = std::env::var("WIN") {
            let (a, b) = w.split_once(",").unwrap();
            let (a, b): (f64, f64) = (a.parse().unwrap(), b.parse().unwrap());
            for c in &c {
                if c.time_s > a && c.time_s < b && c.strength > 0.0 {
                    println!("  c {:.4} {:.1}", c.time_s, c.strength);
                }
            }
        }
        println!(
            "{f} ch {ch} cands {} detect {:?} seq {:?} drops {} rej {}",
            c.len(),
            t1 - t0,
            t1.elapsed(),
            found.drops.len(),
            found.rejected.len()
        );
        for d in &found.drops {
            println!(
                "  drop n {} evidence {:.1} rejected {}",
                d.links.len(),
                d.evidence,
                d.rejected.len()
            );
            let mut last = f64::NAN;
            let mut lf = f64::NAN;
            for l in &d.links {
                let fl = l.time_s - last;
                println!(
                    "   {:8.4} {:8.2} ms r {:.4} gain {:5.1} {} s {:.1}",
                    l.time_s,
                    fl * 1e3,
                    fl / lf,
                    l.gain,
                    if l.event.is_some() { "" } else { "inferred" },
                    l.event.map_or(0.0, |i| ev[i].strength)
                );
                lf = fl;
                last = l.time_s;
            }
        }
    }
}
