//! The two formats: OpenMetrics 1.0, and the older text format of Prometheus (version 0.0.4), which differ in the names of
//! counters, in units and at the end.
//!
//! The existing libraries know only one of the two each, and there is little more to it than these lines.

use std::fmt::{Debug, Write as _};

use axum::http::HeaderMap;
use axum::http::header::ACCEPT;

use crate::engine::Histogram;

/// A format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    OpenMetrics,
    Prometheus,
}

impl Format {
    /// The format that is asked for: OpenMetrics only if it is named, because few programs know it.
    pub(super) fn asked(headers: &HeaderMap) -> Self {
        let values = headers.get_all(ACCEPT).into_iter().filter_map(|value| value.to_str().ok());
        let (mut open, mut plain) = (0.0, 0.0);
        for range in values.flat_map(|value| value.split(',')) {
            let mut parts = range.split(';').map(str::trim);
            let (kind, parameters) = (parts.next().unwrap_or_default(), parts);
            let pairs: Vec<_> = parameters.filter_map(|pair| pair.split_once('=')).collect();
            let find = |name: &str| pairs.iter().find(|(known, _)| *known == name).map(|(_, value)| *value);
            let quality: f32 = find("q").map_or(1.0, |value| value.parse().unwrap_or(0.0));
            match kind.to_ascii_lowercase().as_str() {
                "application/openmetrics-text" if find("version").is_none_or(|value| value == "1.0.0") => {
                    open = quality;
                }
                "text/plain" => plain = quality.max(plain),
                _ => {}
            }
        }
        if open > 0.0 && open >= plain { Self::OpenMetrics } else { Self::Prometheus }
    }

    pub(super) const fn media_type(self) -> &'static str {
        match self {
            Self::OpenMetrics => "application/openmetrics-text; version=1.0.0; charset=utf-8",
            Self::Prometheus => "text/plain; version=0.0.4; charset=utf-8",
        }
    }
}

/// The kind of a metric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Counter,
    Gauge,
    Histogram,
    /// Always 1; its labels have the information.
    Info,
}

/// A metric.
#[derive(Clone, Copy, Debug)]
pub(super) struct Metric {
    /// Its name without the suffix of its kind. A metric whose name ends in `_seconds` is in seconds.
    name: &'static str,
    kind: Kind,
    /// What it is, in a sentence.
    help: &'static str,
}

pub(super) const fn counter(name: &'static str, help: &'static str) -> Metric {
    Metric { name, kind: Kind::Counter, help }
}

pub(super) const fn gauge(name: &'static str, help: &'static str) -> Metric {
    Metric { name, kind: Kind::Gauge, help }
}

pub(super) const fn histogram(name: &'static str, help: &'static str) -> Metric {
    Metric { name, kind: Kind::Histogram, help }
}

pub(super) const fn info(name: &'static str, help: &'static str) -> Metric {
    Metric { name, kind: Kind::Info, help }
}

impl Metric {
    /// The suffix of its samples' names.
    const fn suffix(&self) -> &'static str {
        match self.kind {
            Kind::Counter => "_total",
            Kind::Info => "_info",
            Kind::Gauge | Kind::Histogram => "",
        }
    }
}

/// A label with its value.
pub(super) type Label<'a> = (&'static str, &'a str);

/// The text, metric after metric.
#[derive(Debug)]
pub(super) struct Text {
    format: Format,
    text: String,
}

impl Text {
    pub(super) const fn new(format: Format) -> Self {
        Self { format, text: String::new() }
    }

    /// Begins `metric`, whose samples follow. It is described even if there are none.
    pub(super) fn of<'a>(&'a mut self, metric: &'a Metric) -> Samples<'a> {
        let Metric { name, kind, help } = metric;
        let (kind, suffix) = match (self.format, kind) {
            (_, Kind::Gauge) => ("gauge", ""),
            (_, Kind::Histogram) => ("histogram", ""),
            (Format::OpenMetrics, Kind::Counter) => ("counter", ""),
            (Format::OpenMetrics, Kind::Info) => ("info", ""),
            (Format::Prometheus, Kind::Counter) => ("counter", metric.suffix()),
            (Format::Prometheus, Kind::Info) => ("gauge", metric.suffix()),
        };
        let text = &mut self.text;
        let _ = writeln!(text, "# TYPE {name}{suffix} {kind}");
        if self.format == Format::OpenMetrics && name.ends_with("_seconds") {
            let _ = writeln!(text, "# UNIT {name}{suffix} seconds");
        }
        let _ = writeln!(text, "# HELP {name}{suffix} {help}");
        Samples { metric, text }
    }

    /// The complete text.
    pub(super) fn end(mut self) -> String {
        if self.format == Format::OpenMetrics {
            self.text.push_str("# EOF\n");
        }
        self.text
    }
}

/// The samples of a metric.
#[derive(Debug)]
pub(super) struct Samples<'a> {
    metric: &'a Metric,
    text: &'a mut String,
}

impl Samples<'_> {
    /// Writes a sample with these labels; the number is a whole or a real one.
    pub(super) fn put(&mut self, labels: &[Label<'_>], number: impl Debug) {
        self.line(self.metric.suffix(), labels, number);
    }

    /// Writes a whole histogram with these labels.
    pub(super) fn spread(&mut self, labels: &[Label<'_>], of: &Histogram) {
        let mut bucket = |bound: &str, count: u64| {
            let labels = [labels, &[("le", bound)]].concat();
            self.line("_bucket", &labels, count);
        };
        for (bound, count) in of.up_to() {
            bucket(&format!("{bound:?}"), count);
        }
        bucket("+Inf", of.count());
        self.line("_sum", labels, of.sum());
        self.line("_count", labels, of.count());
    }

    fn line(&mut self, suffix: &str, labels: &[Label<'_>], number: impl Debug) {
        let _ = write!(self.text, "{}{suffix}", self.metric.name);
        for (place, (name, value)) in labels.iter().enumerate() {
            self.text.push(if place == 0 { '{' } else { ',' });
            let _ = write!(self.text, "{name}=\"");
            escape(self.text, value);
            self.text.push('"');
        }
        let end = if labels.is_empty() { "" } else { "}" };
        // Real numbers with a point, as OpenMetrics wants the bounds of a histogram.
        let _ = writeln!(self.text, "{end} {number:?}");
    }
}

/// Escapes the value of a label, as both formats want it.
fn escape(text: &mut String, value: &str) {
    for letter in value.chars() {
        match letter {
            '\\' => text.push_str("\\\\"),
            '"' => text.push_str("\\\""),
            '\n' => text.push_str("\\n"),
            other => text.push(other),
        }
    }
}

#[cfg(test)]
mod tests {
    use axum::http::HeaderValue;

    use super::*;

    #[test]
    fn openmetrics_is_for_those_who_ask_for_it() {
        // As Prometheus 2.42 and 3.5, curl and Firefox ask, and as others might.
        let open = [
            "application/openmetrics-text;version=1.0.0,application/openmetrics-text;version=0.0.1;q=0.75,text/plain;version=0.0.4;q=0.5,*/*;q=0.1",
            "application/openmetrics-text;version=1.0.0;escaping=allow-utf-8;q=0.6,application/openmetrics-text;version=0.0.1;q=0.5,text/plain;version=1.0.0;escaping=allow-utf-8;q=0.4,text/plain;version=0.0.4;q=0.3,*/*;q=0.2",
            "application/openmetrics-text",
        ];
        let plain = [
            "*/*",
            "text/html,application/xhtml+xml,application/xml;q=0.9,*/*;q=0.8",
            "text/plain, application/openmetrics-text; q=0.5",
            "application/openmetrics-text;q=0",
            "application/openmetrics-text;version=2.0.0",
            "",
        ];
        let asked =
            |accept| Format::asked(&HeaderMap::from_iter([(ACCEPT, HeaderValue::from_static(accept))]));
        for accept in open {
            assert_eq!(asked(accept), Format::OpenMetrics, "{accept}");
        }
        for accept in plain {
            assert_eq!(asked(accept), Format::Prometheus, "{accept}");
        }
        assert_eq!(Format::asked(&HeaderMap::new()), Format::Prometheus);
    }
}
