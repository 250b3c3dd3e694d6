//! Twenty drops in one stream, told while they are played: how soon, how often, how right, and what it costs.
//!
//! ```text
//! cargo run --release --example live            a row per room
//! cargo run --release --example live -- drops   a row per drop
//! ```
//!
//! The clock is that of the stream: a drop is told when so many seconds of it were fed. The cost is processor time over the
//! length of the stream, which is known on Linux alone. `docs/listen.md` has the table.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::cast_precision_loss,
    reason = "an example prints, and stops at the first surprise; counts are small"
)]

mod stage;
mod table;
mod trial;

fn main() {
    let each = std::env::args().nth(1).is_some_and(|word| word == "drops");
    println!("{}", table::heading(each));
    for room in stage::ROOMS {
        let trial = trial::played(room);
        match each {
            true => print!("{}", table::drops(room, &trial)),
            false => println!("{}", table::row(room, &trial)),
        }
    }
}
