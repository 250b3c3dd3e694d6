//! Who does work that is independent: one piece after another, or the threads that the command brings.

/// A piece of work.
pub type Task<'a> = Box<dyn FnOnce() + Send + 'a>;

/// Does independent pieces of work. The core has no threads: who has some says how they are given tasks.
#[derive(Debug, Clone, Copy, Default)]
pub struct Workers(Option<fn(Vec<Task<'_>>)>);

impl Workers {
    /// Workers that do all of some tasks, in any order, before `run` returns.
    #[must_use]
    pub fn new(run: fn(Vec<Task<'_>>)) -> Self {
        Self(Some(run))
    }

    /// Whether there may be several, so that work is worth being gathered for them.
    #[must_use]
    pub fn are_many(self) -> bool {
        self.0.is_some()
    }

    /// What the work makes of each item, in the order of the items: the same whoever does it.
    pub fn map<T: Send, U: Send>(self, items: Vec<T>, work: impl Fn(T) -> U + Sync) -> Vec<U> {
        let Some(run) = self.0.filter(|_| items.len() > 1) else {
            return items.into_iter().map(work).collect();
        };
        let work = &work;
        let mut done: Vec<Option<U>> = items.iter().map(|_| None).collect();
        let mut tasks: Vec<Task<'_>> = Vec::new();
        for (place, item) in done.iter_mut().zip(items) {
            tasks.push(Box::new(move || *place = Some(work(item))));
        }
        run(tasks);
        done.into_iter().flatten().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As threads may go about it: the last task first.
    fn backwards(tasks: Vec<Task<'_>>) {
        tasks.into_iter().rev().for_each(|task| task());
    }

    #[test]
    fn results_are_in_the_order_of_the_items_whoever_does_the_work() {
        let items: Vec<usize> = (0..9).collect();
        let (one, many) = (Workers::default(), Workers::new(backwards));
        let squares = |workers: Workers| workers.map(items.clone(), |n| n * n);
        assert_eq!(squares(one), [0, 1, 4, 9, 16, 25, 36, 49, 64]);
        assert_eq!(squares(many), squares(one));
    }
}
