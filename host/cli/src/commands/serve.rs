//! `halfrow serve`

use std::path::PathBuf;

use clap::Args;

use super::{Failure, print};
use crate::arguments::board::refuse_recording;
use crate::exit::Exit;
use crate::serve::{Hosted, Name, Port, Pty, ServeError, TcpPlace, Traffic};
use crate::signals;
use halfrow::target::Target;
use halfrow::words::plain;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The board to serve
    #[arg(long, value_name = "TARGET", default_value = "mock", value_parser = crate::arguments::board::target())]
    board: Target,
    /// A TCP port instead of a pseudo-terminal: PORT of this computer alone, or ADDRESS:PORT; 0 for any that is free
    #[arg(long, value_name = "PORT")]
    tcp: Option<TcpPlace>,
    /// A symbolic link to the pseudo-terminal, which has another name every time
    #[arg(long, value_name = "PATH", conflicts_with = "tcp")]
    link: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    refuse_recording(&arguments.board)?;
    let mut board = Hosted::open(&arguments.board)?;
    let stopped = signals::heed();
    let mut ended = |_: Traffic| stopped().is_some();
    let served = match &arguments.tcp {
        Some(place) => {
            let port = Port::listen(place).map_err(failed)?;
            let address = port.address().map_err(failed)?;
            print(&format!("tcp:{address}"))?;
            port.serve(&mut board, &mut ended)
        }
        None => serve_pty(arguments, &mut board, &mut ended)?,
    };
    served.map_err(failed)?;
    Ok(Exit::Pass)
}

fn failed(error: ServeError) -> Failure {
    Failure::of(error.exit(), error)
}

fn serve_pty(
    arguments: &Arguments,
    board: &mut Hosted,
    ended: &mut dyn FnMut(Traffic) -> bool,
) -> Result<Result<(), ServeError>, Failure> {
    let pty = Pty::open().map_err(failed)?;
    let name = arguments.link.as_ref().map(|path| Name::link(path, pty.path())).transpose();
    let name = name.map_err(Failure::call)?;
    let path = arguments.link.as_deref().filter(|_| name.is_some()).unwrap_or(pty.path());
    print(&plain(&format!("serial:{}", path.display())))?;
    Ok(pty.serve(board, ended))
}
