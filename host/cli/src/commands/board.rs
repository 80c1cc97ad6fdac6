//! The options of the board and its link, which several commands share.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use clap::Args;

use super::{Failure, wrong_call};
use crate::exit::Exit;
use crate::settings::Settings;
use halfrow::board::deadlines::RetryLimit;
use halfrow::board::{OpenOptions, Stop};
use halfrow::link::{self, Candidate, Recording};
use halfrow::run::Draws;
use halfrow::target::Target;

/// Which board, and how patiently.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Board")]
pub(super) struct BoardArguments {
    /// The board: mock, mock,fault=NAME, sim, serial:PATH, tcp:HOST:PORT, replay:FILE; see `halfrow boards` [default: mock]
    #[arg(long, value_name = "TARGET", env = "HALFROW_BOARD")]
    board: Option<Target>,
    /// The longest that the run may take, in seconds of the link's clock
    #[arg(long, value_name = "SECONDS", env = "HALFROW_TIMEOUT")]
    timeout: Option<f64>,
    /// Packets that may be sent again, in percent of those sent, beyond 16; above it the link is too poor [default: 5]
    #[arg(long, value_name = "PERCENT", env = "HALFROW_RETRY_LIMIT", value_parser = percent)]
    retry_limit: Option<f64>,
    /// Take the board over from another host that holds it
    #[arg(long)]
    pub(super) take_over: bool,
}

fn percent(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|percent| (0.0..=100.0).contains(percent));
    number.ok_or_else(|| "give a number of percent, 0 to 100".to_owned())
}

impl BoardArguments {
    /// Whether a board was named at all.
    pub(super) fn is_named(&self, settings: &Settings) -> bool {
        self.board.is_some() || settings.board.is_some()
    }

    fn target(&self, settings: &Settings) -> Result<Target, Failure> {
        match (&self.board, &settings.board) {
            (Some(target), _) => Ok(target.clone()),
            (None, Some(text)) => text.parse().map_err(Failure::call),
            (None, None) => Ok(Target::mock()),
        }
    }

    /// The link to the board that is named; by default the mock, never a guess.
    pub(super) fn candidate(&self, settings: &Settings) -> Result<Candidate, Failure> {
        Ok(link::open(&self.target(settings)?)?)
    }

    /// The recording, if the target is one.
    pub(super) fn recording(&self, settings: &Settings) -> Result<Option<Recording>, Failure> {
        let file = link::replayed_file(&self.target(settings)?);
        file.map(|file| Recording::read(&file)).transpose().map_err(Failure::call)
    }

    pub(super) fn open_options(
        &self,
        settings: &Settings,
        draws: Option<Draws>,
    ) -> Result<OpenOptions, Failure> {
        let Draws { nonce, host } = draws.unwrap_or_else(Draws::draw);
        Ok(OpenOptions {
            nonce,
            host,
            take_over: self.take_over,
            polite: false,
            retry_limit: self.retry_limit(settings),
            stop: stop()?.limited(self.timeout(settings)?),
        })
    }

    pub(super) fn timeout(&self, settings: &Settings) -> Result<Option<Duration>, Failure> {
        let seconds = self.timeout.or(settings.timeout);
        let limit = seconds.map(Duration::try_from_secs_f64).transpose();
        limit.map_err(|_| wrong_call!("--timeout takes a number of seconds, 0 or more"))
    }

    pub(super) fn retry_limit(&self, settings: &Settings) -> RetryLimit {
        let limit = RetryLimit::default();
        match self.retry_limit.or(settings.retry_limit) {
            Some(percent) => RetryLimit { share: percent / 100.0, ..limit },
            None => limit,
        }
    }
}

/// What ends a run early: Ctrl-C or SIGTERM. A second signal ends the program at once.
pub(super) fn stop() -> Result<Stop, Failure> {
    let signal = signals()?;
    Ok(Stop::when(move || Exit::stopped_by(signal.load(Ordering::Relaxed))))
}

/// Holds the exit code of the signal that came, Ctrl-C or SIGTERM, and 0 before. A second one ends the program at once.
pub(super) fn signals() -> Result<Arc<AtomicUsize>, Failure> {
    use signal_hook::consts::{SIGINT, SIGTERM};
    let signal = Arc::new(AtomicUsize::new(0));
    for (number, exit) in [(SIGINT, Exit::Interrupted), (SIGTERM, Exit::Terminated)] {
        let code = usize::from(exit.code());
        let second = Arc::new(std::sync::atomic::AtomicBool::new(false));
        signal_hook::flag::register_conditional_shutdown(number, exit.code().into(), Arc::clone(&second))
            .map_err(Failure::error)?;
        signal_hook::flag::register(number, second).map_err(Failure::error)?;
        signal_hook::flag::register_usize(number, Arc::clone(&signal), code).map_err(Failure::error)?;
    }
    Ok(signal)
}
