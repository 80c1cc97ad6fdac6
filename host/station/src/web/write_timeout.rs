//! A connection whose other end must take what it is sent.

use std::io::{self, IoSlice};
use std::pin::Pin;
use std::task::{Context, Poll, ready};
use std::time::Duration;

use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::TcpStream;
use tokio::time::{Sleep, sleep};

/// How long the other end may take nothing. A computer that was switched off holds no slot for longer.
const PATIENCE: Duration = Duration::from_secs(30);

/// A connection that breaks when nothing can be written for [`PATIENCE`].
#[derive(Debug)]
pub(super) struct WriteTimeout {
    stream: TcpStream,
    stuck: Option<Pin<Box<Sleep>>>,
}

impl WriteTimeout {
    /// Wraps this connection.
    pub(super) fn new(stream: TcpStream) -> Self {
        Self { stream, stuck: None }
    }

    /// The result of a write; an error if it has been pending for too long.
    fn settled<T>(&mut self, to: &mut Context<'_>, written: Poll<io::Result<T>>) -> Poll<io::Result<T>> {
        if written.is_ready() {
            self.stuck = None;
            return written;
        }
        let stuck = self.stuck.get_or_insert_with(|| Box::pin(sleep(PATIENCE)));
        ready!(stuck.as_mut().poll(to));
        Poll::Ready(Err(io::ErrorKind::TimedOut.into()))
    }
}

impl AsyncRead for WriteTimeout {
    fn poll_read(
        mut self: Pin<&mut Self>,
        to: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_read(to, buffer)
    }
}

impl AsyncWrite for WriteTimeout {
    fn poll_write(mut self: Pin<&mut Self>, to: &mut Context<'_>, bytes: &[u8]) -> Poll<io::Result<usize>> {
        let written = Pin::new(&mut self.stream).poll_write(to, bytes);
        self.settled(to, written)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        to: &mut Context<'_>,
        bytes: &[IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        let written = Pin::new(&mut self.stream).poll_write_vectored(to, bytes);
        self.settled(to, written)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, to: &mut Context<'_>) -> Poll<io::Result<()>> {
        let flushed = Pin::new(&mut self.stream).poll_flush(to);
        self.settled(to, flushed)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, to: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(to)
    }
}

#[cfg(test)]
mod tests {
    use tokio::runtime::Builder;
    use tokio::time::Instant;

    use super::*;

    #[test]
    fn who_takes_nothing_for_half_a_minute_is_given_nothing_more() {
        let runtime = Builder::new_current_thread().enable_all().build().unwrap();
        runtime.block_on(async {
            let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
            let stream = TcpStream::connect(listener.local_addr().unwrap()).await.unwrap();
            let mut stream = WriteTimeout::new(stream);
            let written = |stream: &mut WriteTimeout, poll: Poll<io::Result<usize>>| {
                stream.settled(&mut Context::from_waker(std::task::Waker::noop()), poll)
            };
            let begun = Instant::now();
            assert!(written(&mut stream, Poll::Pending).is_pending());
            let until = stream.stuck.as_ref().unwrap().deadline();
            // The timer counts whole milliseconds.
            let tick = Duration::from_millis(1);
            let half_a_minute =
                begun + Duration::from_secs(30) - tick..=Instant::now() + Duration::from_secs(30) + tick;
            assert!(half_a_minute.contains(&until), "{:?}", until - begun);
            // What is taken meanwhile gives it as long again.
            assert!(written(&mut stream, Poll::Ready(Ok(1))).is_ready());
            assert!(stream.stuck.is_none());
            assert!(written(&mut stream, Poll::Pending).is_pending());
            stream.stuck.as_mut().unwrap().as_mut().reset(Instant::now() - tick);
            let Poll::Ready(Err(error)) = written(&mut stream, Poll::Pending) else { panic!("it is over") };
            assert_eq!(error.kind(), io::ErrorKind::TimedOut);
        });
    }
}
