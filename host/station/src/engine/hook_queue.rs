//! The hooks of a lane, in the order of what they show.

use std::io;
use std::sync::mpsc::{self, Receiver};
use std::thread::{self, JoinHandle};

/// The most verdicts whose hooks may be unfinished; those of further ones are not started. A hook that hangs is killed
/// at its deadline, and lamps and labels should not tell of boards that are long gone.
const MOST: usize = 4;

/// Why hooks are not started.
#[derive(Debug)]
pub(super) enum NotStarted {
    /// The hooks of this many earlier verdicts are not done.
    Behind(usize),
    /// The system has no thread for it.
    NoThread(io::Error),
}

/// What hooks show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shows {
    /// A verdict.
    Verdict,
    /// That there is no verdict any more. It is begun after every verdict, however much waits: a lamp must not stay green
    /// over the next board.
    Nothing,
}

/// The hooks of one lane.
#[derive(Debug)]
pub(super) struct HookQueue {
    threads: Vec<(JoinHandle<()>, Shows)>,
    /// Ends when the hooks that were begun last are done.
    last: Receiver<()>,
}

impl HookQueue {
    pub(super) fn new() -> Self {
        Self { threads: Vec::new(), last: mpsc::channel().1 }
    }

    /// Does `work`, which `shows` this, in a thread of this name, once all that was begun before is done.
    ///
    /// # Errors
    /// [`NotStarted`]
    pub(super) fn begin(
        &mut self,
        shows: Shows,
        name: String,
        work: impl FnOnce() + Send + 'static,
    ) -> Result<(), NotStarted> {
        self.threads.retain(|(thread, _)| !thread.is_finished());
        let verdicts = self.threads.iter().filter(|(_, shows)| *shows == Shows::Verdict).count();
        match shows {
            Shows::Verdict if verdicts >= MOST => return Err(NotStarted::Behind(verdicts)),
            Shows::Nothing if self.threads.last().is_some_and(|(_, last)| *last == shows) => return Ok(()),
            _ => {}
        }
        // The turn is taken only once there is a thread for it.
        let (give, turn) = mpsc::channel::<(Receiver<()>, mpsc::Sender<()>)>();
        let waiting = move || {
            let Ok((before, done)) = turn.recv() else { return };
            // Nothing is ever sent; the channel just closes.
            let _ = before.recv();
            work();
            drop(done);
        };
        let thread = thread::Builder::new().name(name).spawn(waiting).map_err(NotStarted::NoThread)?;
        self.threads.push((thread, shows));
        let (done, last) = mpsc::channel();
        let _ = give.send((std::mem::replace(&mut self.last, last), done));
        Ok(())
    }

    /// The threads that are not done yet.
    pub(super) fn into_threads(self) -> impl Iterator<Item = JoinHandle<()>> {
        self.threads.into_iter().map(|(thread, _)| thread)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::{Arc, Mutex};

    use super::*;

    #[test]
    fn what_was_begun_first_is_done_first_and_so_much_waits_and_no_more() {
        let (mut queue, done) = (HookQueue::new(), Arc::new(Mutex::new(Vec::new())));
        let (go, held) = mpsc::channel::<()>();
        let mut held = Some(held);
        for number in 0..4 {
            let (done, held) = (Arc::clone(&done), held.take());
            let work = move || {
                if let Some(held) = held {
                    let _ = held.recv();
                }
                done.lock().unwrap().push(number);
            };
            queue.begin(Shows::Verdict, "hooks".to_owned(), work).unwrap();
        }
        let one_more = queue.begin(Shows::Verdict, "hooks".to_owned(), || panic!("there is no room for it"));
        assert!(matches!(one_more, Err(NotStarted::Behind(4))), "{one_more:?}");
        for number in [4, 5] {
            let done = Arc::clone(&done);
            let cleared = move || done.lock().unwrap().push(number);
            queue.begin(Shows::Nothing, "hooks".to_owned(), cleared).unwrap();
        }
        assert!(done.lock().unwrap().is_empty());
        drop(go);
        queue.into_threads().for_each(|thread| thread.join().unwrap());
        assert_eq!(*done.lock().unwrap(), [0, 1, 2, 3, 4], "the last verdict is cleared, once");
    }
}
