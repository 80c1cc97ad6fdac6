//! Two threads that keep a device's endpoints busy, and the queues between them and the link.

use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use super::packets::LineErrors;
use super::transport::{Failure, Transport};

/// Bytes of a read: a multiple of every packet's size, since a packet that does not fit is lost.
const READ: usize = 64 * 1024;

/// Bytes of a write. FPGAs were seen to lose bytes of larger ones.
const WRITE: usize = 16 * 1024;

/// Bytes that may wait to be written. Whoever sends counts them as sent.
const OUTGOING: usize = 2 * WRITE;

/// Bytes that may wait to be fetched; beyond, the device waits. A board sends what it has credit for, noise has no end.
const INCOMING: usize = 1 << 20;

/// How often the threads look whether they are still wanted.
const BREATH: Duration = Duration::from_millis(100);

/// Takes a transfer apart and appends the data in it.
pub(super) type Unpack = dyn Fn(&[u8], &mut Vec<u8>, &mut LineErrors) + Send + Sync;

#[derive(Default)]
struct Queues {
    incoming: Vec<u8>,
    outgoing: VecDeque<u8>,
    errors: LineErrors,
    failure: Option<Failure>,
    is_over: bool,
}

struct Shared {
    transport: Box<dyn Transport>,
    unpack: Box<Unpack>,
    queues: Mutex<Queues>,
    /// Something has arrived, left, or failed.
    changed: Condvar,
}

impl Shared {
    fn queues(&self) -> MutexGuard<'_, Queues> {
        self.queues.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait<'a>(&self, queues: MutexGuard<'a, Queues>, time: Duration) -> MutexGuard<'a, Queues> {
        match self.changed.wait_timeout(queues, time) {
            Ok((queues, _)) => queues,
            Err(poisoned) => poisoned.into_inner().0,
        }
    }

    fn fail(&self, failure: Failure) {
        let mut queues = self.queues();
        queues.failure.get_or_insert(failure);
        queues.is_over = true;
        self.changed.notify_all();
    }

    /// Always has a read under way, and does nothing between two of them that could wait.
    fn keep_reading(&self) {
        let mut buffer = vec![0; READ];
        let mut data = Vec::new();
        loop {
            let read = match self.transport.read(&mut buffer, BREATH) {
                Ok(read) => read,
                Err(failure) => return self.fail(failure),
            };
            let mut errors = LineErrors::default();
            (self.unpack)(&buffer[..read], &mut data, &mut errors);
            let mut queues = self.queues();
            queues.errors += errors;
            if !data.is_empty() {
                queues.incoming.append(&mut data);
                self.changed.notify_all();
            }
            while queues.incoming.len() > INCOMING && !queues.is_over {
                queues = self.wait(queues, BREATH);
            }
            if queues.is_over {
                return;
            }
        }
    }

    fn keep_writing(&self) {
        let mut bytes = Vec::with_capacity(WRITE);
        loop {
            let mut queues = self.queues();
            while bytes.is_empty() && queues.outgoing.is_empty() && !queues.is_over {
                queues = self.wait(queues, BREATH);
            }
            if queues.is_over {
                return;
            }
            let more = queues.outgoing.len().min(WRITE - bytes.len());
            bytes.extend(queues.outgoing.drain(..more));
            drop(queues);
            self.changed.notify_all();
            match self.transport.write(&bytes, BREATH) {
                Ok(written) => drop(bytes.drain(..written)),
                Err(failure) => return self.fail(failure),
            }
        }
    }
}

/// The two threads at work.
pub(super) struct Pump {
    shared: Arc<Shared>,
    threads: Vec<JoinHandle<()>>,
}

impl Pump {
    pub(super) fn start(transport: Box<dyn Transport>, unpack: Box<Unpack>) -> Self {
        let queues = Mutex::new(Queues::default());
        let shared = Arc::new(Shared { transport, unpack, queues, changed: Condvar::new() });
        let (reading, writing) = (Arc::clone(&shared), Arc::clone(&shared));
        let threads = vec![
            thread::spawn(move || reading.keep_reading()),
            thread::spawn(move || writing.keep_writing()),
        ];
        Self { shared, threads }
    }

    /// As [`Link::exchange`](crate::link::Link::exchange). What has arrived before a failure is handed over first.
    pub(super) fn exchange(
        &self,
        outgoing: &[u8],
        incoming: &mut Vec<u8>,
        wait: Duration,
    ) -> Result<usize, Failure> {
        let deadline = Instant::now() + wait;
        let mut queues = self.shared.queues();
        loop {
            let room =
                if queues.failure.is_none() { OUTGOING - queues.outgoing.len().min(OUTGOING) } else { 0 };
            let taken = outgoing.len().min(room);
            queues.outgoing.extend(&outgoing[..taken]);
            let received = queues.incoming.len();
            incoming.append(&mut queues.incoming);
            if taken + received > 0 {
                self.shared.changed.notify_all();
                return Ok(taken);
            }
            if let Some(failure) = &queues.failure {
                return Err(failure.clone());
            }
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Ok(0);
            }
            queues = self.shared.wait(queues, left);
        }
    }

    pub(super) fn errors(&self) -> LineErrors {
        self.shared.queues().errors
    }
}

impl Drop for Pump {
    /// Waits for what is still to be written, since the last words of a session free the board, but not for ever.
    fn drop(&mut self) {
        let deadline = Instant::now() + 2 * BREATH;
        let mut queues = self.shared.queues();
        while !queues.outgoing.is_empty() && !queues.is_over && Instant::now() < deadline {
            queues = self.shared.wait(queues, BREATH / 10);
        }
        queues.is_over = true;
        drop(queues);
        self.shared.changed.notify_all();
        for thread in self.threads.drain(..) {
            // A thread that panicked has said so.
            let _ = thread.join();
        }
    }
}
