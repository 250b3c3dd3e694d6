//! Work on many threads whose results are taken in order.

use std::collections::BTreeMap;
use std::io;
use std::ops::{ControlFlow, Range};
use std::sync::mpsc::{self, Receiver};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use crate::Error;

/// How far the threads may be ahead of the first result that is not there yet. While one recording takes hours, the
/// results of so many others wait for it in memory.
const AHEAD: usize = 256;

/// Does the work for each number on so many threads, and takes the results in the order of the numbers, each as soon as
/// all before it were taken; until there are no more, or the taker breaks off.
pub(super) fn in_order<T: Send>(
    threads: usize,
    numbers: Range<usize>,
    work: impl Fn(usize) -> T + Sync,
    take: impl FnMut(T) -> Result<ControlFlow<()>, Error>,
) -> Result<(), Error> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(io::Error::other)?;
    let queue = Queue::new(numbers);
    let (send, receive) = mpsc::channel();
    pool.in_place_scope(|scope| {
        for _ in 0..threads {
            let (send, queue, work) = (send.clone(), &queue, &work);
            scope.spawn(move |_| {
                while let Some(number) = queue.claim() {
                    if send.send((number, work(number))).is_err() {
                        break;
                    }
                }
            });
        }
        // The threads hold the only senders now: without them, receiving ends.
        drop(send);
        let taken = deliver(&receive, &queue, take);
        queue.stop();
        taken
    })
}

fn deliver<T>(
    receive: &Receiver<(usize, T)>,
    queue: &Queue,
    mut take: impl FnMut(T) -> Result<ControlFlow<()>, Error>,
) -> Result<(), Error> {
    let mut waiting = BTreeMap::new();
    for (number, result) in receive {
        waiting.insert(number, result);
        while let Some(result) = waiting.remove(&queue.first_missing()) {
            if take(result)?.is_break() {
                return Ok(());
            }
            queue.taken();
        }
    }
    Ok(())
}

/// Numbers to be worked on, handed out in order, never too far ahead.
#[derive(Debug)]
struct Queue {
    state: Mutex<State>,
    moved: Condvar,
}

#[derive(Debug)]
struct State {
    next: usize,
    taken: usize,
    end: usize,
}

impl Queue {
    const fn new(numbers: Range<usize>) -> Self {
        Self {
            state: Mutex::new(State {
                next: numbers.start,
                taken: numbers.start,
                end: numbers.end,
            }),
            moved: Condvar::new(),
        }
    }

    /// The state is whole at every moment, so a thread that broke off leaves nothing half done.
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next number, once it is near enough; none at the end.
    fn claim(&self) -> Option<usize> {
        let far = |s: &mut State| s.next < s.end && s.next >= s.taken + AHEAD;
        let waited = self.moved.wait_while(self.state(), far);
        let mut state = waited.unwrap_or_else(PoisonError::into_inner);
        let number = state.next;
        (number < state.end).then(|| {
            state.next += 1;
            number
        })
    }

    fn first_missing(&self) -> usize {
        self.state().taken
    }

    fn taken(&self) {
        self.state().taken += 1;
        self.moved.notify_all();
    }

    fn stop(&self) {
        self.state().end = 0;
        self.moved.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    /// Work that takes longer for some numbers than for others.
    fn uneven(number: usize) -> usize {
        (0..(number * 7_919) % 20_000).fold(number, |n, i| std::hint::black_box(n + i - i))
    }

    #[test]
    fn results_come_in_order_whatever_the_threads_do() {
        for threads in [1, 2, 8] {
            let mut got = Vec::new();
            in_order(threads, 3..2_000, uneven, |n| {
                got.push(n);
                Ok(ControlFlow::Continue(()))
            })
            .unwrap();
            assert_eq!(got, (3..2_000).collect::<Vec<_>>());
        }
    }

    #[test]
    fn nobody_runs_far_ahead_of_a_slow_one() {
        let started = AtomicUsize::new(0);
        let work = |number: usize| {
            started.fetch_add(1, Ordering::SeqCst);
            // The first ends only when all that may start before it is taken did.
            while number == 0 && started.load(Ordering::SeqCst) < AHEAD {
                std::thread::yield_now();
            }
            number
        };
        let mut most = None;
        in_order(2, 0..1_000, work, |_| {
            most.get_or_insert_with(|| started.load(Ordering::SeqCst));
            Ok(ControlFlow::Continue(()))
        })
        .unwrap();
        assert_eq!(most, Some(AHEAD));
    }

    #[test]
    fn a_taker_that_breaks_off_or_fails_ends_the_work() {
        let mut taken = 0;
        in_order(2, 0..100_000, uneven, |_| {
            taken += 1;
            Ok(if taken == 5 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            })
        })
        .unwrap();
        assert_eq!(taken, 5);
        let failed = in_order(2, 0..100_000, uneven, |_| {
            Err(io::Error::other("full").into())
        });
        assert_eq!(failed.unwrap_err().to_string(), "full");
        in_order(2, 0..0, uneven, |_| panic!("nothing to take")).unwrap();
    }
}
