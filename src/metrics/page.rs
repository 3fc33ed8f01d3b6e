//! The page that Prometheus reads: its text format, version 0.0.4.

use std::fmt::{Display, Write as _};

use super::Histogram;

/// The media type of the page.
pub const MEDIA_TYPE: &str = "text/plain; version=0.0.4; charset=utf-8";

/// A page being written, family by family. Names and labels are our own: nothing that a client makes up may come here.
#[derive(Debug, Default)]
pub struct Page(String);

/// The name of a label, and its value.
pub type Label<'a> = (&'a str, &'a str);

impl Page {
    /// Begins a family of samples; `kind` is `counter`, `gauge` or `histogram`.
    pub fn family(&mut self, name: &str, kind: &str, help: &str) {
        self.line(format_args!("# HELP {name} {help}"));
        self.line(format_args!("# TYPE {name} {kind}"));
    }

    /// A sample of a counter or a gauge.
    pub fn sample(&mut self, name: &str, labels: &[Label<'_>], value: impl Display) {
        self.line(format_args!("{name}{} {value}", Labels(labels, None)));
    }

    /// A family of one sample.
    pub fn single(&mut self, name: &str, kind: &str, help: &str, value: impl Display) {
        self.family(name, kind, help);
        self.sample(name, &[], value);
    }

    /// The samples of a histogram.
    pub fn histogram(&mut self, name: &str, labels: &[Label<'_>], histogram: &Histogram) {
        // The sum first: an observation that comes in between is then in the counts alone, where it does less harm.
        let (sum, mut count) = (histogram.sum(), 0);
        for (bound, below) in histogram.cumulated() {
            let bound = if bound.is_finite() { bound.to_string() } else { "+Inf".to_owned() };
            self.line(format_args!("{name}_bucket{} {below}", Labels(labels, Some(&bound))));
            count = below;
        }
        self.line(format_args!("{name}_sum{} {sum}", Labels(labels, None)));
        self.line(format_args!("{name}_count{} {count}", Labels(labels, None)));
    }

    /// The page as it is sent.
    #[must_use]
    pub fn finish(self) -> String {
        self.0
    }

    fn line(&mut self, line: impl Display) {
        // To write to a string never fails.
        let _ = writeln!(self.0, "{line}");
    }
}

/// Labels as they are written, and the bound of a bucket behind them.
struct Labels<'a>(&'a [Label<'a>], Option<&'a str>);

impl Display for Labels<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Labels(labels, bound) = self;
        let all = labels.iter().copied().chain(bound.map(|bound| ("le", bound)));
        let mut open = '{';
        for (name, value) in all {
            let value = value.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n");
            write!(formatter, "{open}{name}=\"{value}\"")?;
            open = ',';
        }
        if open == ',' { formatter.write_char('}') } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::Page;
    use crate::metrics::Histogram;

    #[test]
    fn a_page_reads_as_the_format_has_it() {
        let mut page = Page::default();
        page.family("moves_total", "counter", "Moves.");
        page.sample("moves_total", &[("by", "\"me\"")], 3);
        let histogram = Histogram::new(&[0.25]);
        [0.125, 4.0].into_iter().for_each(|value| histogram.observe(value));
        page.family("wait_seconds", "histogram", "Waits.");
        page.histogram("wait_seconds", &[], &histogram);
        let expected = "# HELP moves_total Moves.\n# TYPE moves_total counter\nmoves_total{by=\"\\\"me\\\"\"} 3\n\
            # HELP wait_seconds Waits.\n# TYPE wait_seconds histogram\nwait_seconds_bucket{le=\"0.25\"} 1\n\
            wait_seconds_bucket{le=\"+Inf\"} 2\nwait_seconds_sum 4.125\nwait_seconds_count 2\n";
        assert_eq!(page.finish(), expected);
    }
}
