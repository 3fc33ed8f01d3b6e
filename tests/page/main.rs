//! The page at `/`, in a real browser. What needs none is tested in `pure.test.js`.

mod axe;
mod browser;
#[path = "../common/mod.rs"]
mod common;
mod comparing;
mod following;
mod forms;
mod journeys;
mod line_contacts;
mod moving;
mod plots;
mod scene;
mod views;

use common::process::Process;
use reqwest::header;

/// A number of one to a thousand with four digits, without trailing zeros.
fn four(value: f64) -> String {
    digits(value, 4)
}

/// A number of one to a thousand with three digits, without trailing zeros.
fn three(value: f64) -> String {
    digits(value, 3)
}

fn digits(value: f64, count: usize) -> String {
    let places = count - 1 - value.log10().floor() as usize;
    format!("{value:.places$}").parse::<f64>().unwrap().to_string()
}

/// So many digits in MPa or GPa, as the page shows them.
fn pascals(value: f64, count: usize) -> String {
    let (value, unit) = if value >= 1e9 { (value / 1e9, "GPa") } else { (value / 1e6, "MPa") };
    format!("{} {unit}", digits(value, count))
}

/// The contact radius of a steel ball of a radius on a rigid plane, by Hertz, in µm as the page shows it.
fn hertz(force: f64, radius: f64) -> String {
    let modulus = 2.1e11 / (1.0 - 0.3 * 0.3);
    format!("{} µm", four(1e6 * (3.0 * force * radius / (4.0 * modulus)).cbrt()))
}

#[tokio::test]
async fn its_files_are_those_of_the_source_and_are_sent_once() {
    let server = Process::with("memory:", &[]);
    let http = reqwest::Client::new();
    let url = format!("{}/page/main.js", server.base);
    let source = std::fs::read("src/page/main.js").unwrap();
    let mut tags = Vec::new();
    for (accepted, coding) in [("identity", None), ("br, gzip;q=0.5", Some("gzip")), ("gzip;q=0", None)] {
        let ask = || http.get(&url).header(header::ACCEPT_ENCODING, accepted);
        let reply = ask().send().await.unwrap();
        assert_eq!(reply.status(), 200);
        assert_eq!(reply.headers().get(header::CONTENT_ENCODING).map(|coding| coding.to_str().unwrap()), coding);
        let tag = reply.headers()[header::ETAG].clone();
        assert_eq!(reply.bytes().await.unwrap() == source, coding.is_none(), "{accepted}");
        let again = ask().header(header::IF_NONE_MATCH, &tag).send().await.unwrap();
        assert_eq!((again.status().as_u16(), again.headers()[header::ETAG] == tag), (304, true));
        assert!(again.bytes().await.unwrap().is_empty());
        tags.push(tag);
    }
    // Weak, because it is that of two forms.
    assert!(tags.iter().all(|tag| tag == tags[0] && tag.as_bytes().starts_with(b"W/")), "{tags:?}");
    let unknown = http.get(format!("{}/page/..%2Fmain.rs", server.base)).send().await.unwrap();
    assert_eq!(common::problem(unknown).await.code, "not_found");
}
