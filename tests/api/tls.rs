//! TLS: who connects by it gets the certificate in force, and what is not TLS gets nothing.

use crate::common;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

use common::process::{Process, ended};
use common::{binary, until};
use rustls::pki_types::{CertificateDer, ServerName};
use rustls::{ClientConfig, RootCertStore};
use tempfile::tempdir;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;
use tokio_rustls::TlsConnector;

/// A new certificate, written to the files of the service.
fn write_certificate(certificate: &Path, key: &Path) -> CertificateDer<'static> {
    let made = rcgen::generate_simple_self_signed(vec!["localhost".to_owned()]).unwrap();
    std::fs::write(key, made.signing_key.serialize_pem()).unwrap();
    std::fs::write(certificate, made.cert.pem()).unwrap();
    made.cert.der().clone()
}

/// The reply to a request over TLS with exactly this certificate; none where the service has another.
async fn call(address: &str, certificate: &CertificateDer<'static>, request: &str) -> Option<String> {
    let mut roots = RootCertStore::empty();
    roots.add(certificate.clone()).unwrap();
    let provider = Arc::new(rustls::crypto::ring::default_provider());
    let config = ClientConfig::builder_with_provider(provider).with_safe_default_protocol_versions().unwrap();
    let config = config.with_root_certificates(roots).with_no_client_auth();
    let stream = TcpStream::connect(address).await.unwrap();
    let name = ServerName::try_from("localhost").unwrap();
    let mut stream = TlsConnector::from(Arc::new(config)).connect(name, stream).await.ok()?;
    stream.write_all(request.as_bytes()).await.unwrap();
    let mut reply = Vec::new();
    stream.read_to_end(&mut reply).await.unwrap();
    Some(String::from_utf8(reply).unwrap())
}

fn healthcheck(more: &[&str]) -> Command {
    binary(&[&["healthcheck"], more].concat())
}

#[tokio::test]
async fn a_service_with_a_certificate_speaks_tls_alone_and_takes_a_new_one_while_it_runs() {
    let folder = tempdir().unwrap();
    let path = |name: &str| -> PathBuf { folder.path().join(name) };
    let (certificate, key) = (path("cert.pem"), path("key.pem"));
    let first = write_certificate(&certificate, &key);
    let files = ["--tls-cert", certificate.to_str().unwrap(), "--tls-key", key.to_str().unwrap()];
    let server = Process::with("memory:", &files);
    let address = server.base.strip_prefix("https://").unwrap().to_owned();
    let request = "GET /contacts HTTP/1.1\r\nHost: localhost\r\n\r\n";
    // Two requests at once, the second of which asks for the end.
    let both = request.to_owned() + "GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
    let reply = call(&address, &first, &both).await.unwrap();
    assert_eq!(reply.matches("HTTP/1.1 200 OK").count(), 2, "{reply}");

    let mut plain = TcpStream::connect(&address).await.unwrap();
    plain.write_all(request.as_bytes()).await.unwrap();
    let mut answer = Vec::new();
    // A reset is an end like any other.
    let _ = plain.read_to_end(&mut answer).await;
    assert!(!answer.windows(4).any(|part| part == b"HTTP"), "{answer:?}");

    let check = ["--listen", &address, "--tls-cert", files[1]];
    assert!(healthcheck(&check).status().unwrap().success());
    assert!(!healthcheck(&check[..2]).status().unwrap().success());
    // With the flags of `serve`.
    assert!(healthcheck(&[&check[..2], &files].concat()).status().unwrap().success());

    // What is no certificate leaves the one in force.
    std::fs::write(&certificate, "nothing yet").unwrap();
    let kept = "certificate unchanged";
    until("the log says so", async || server.log().contains(kept).then_some(())).await;
    assert!(call(&address, &first, &both).await.is_some());
    let second = write_certificate(&certificate, &key);
    until("the new certificate", async || call(&address, &second, &both).await).await;
    assert!(call(&address, &first, &both).await.is_none());
}

#[test]
fn a_certificate_without_its_key_ends_the_start() {
    let folder = tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let (certificate, key, other) = (path("cert.pem"), path("key.pem"), path("other.pem"));
    write_certificate(&certificate, &other);
    write_certificate(&certificate, &key);
    let text = |path: &PathBuf| path.to_str().unwrap().to_owned();
    for (arguments, why) in [
        (vec!["--tls-cert".to_owned(), text(&certificate)], "without the other"),
        (vec!["--tls-key".to_owned(), text(&key)], "without the other"),
        (
            vec!["--tls-cert".to_owned(), text(&certificate), "--tls-key".to_owned(), text(&other)],
            "not a certificate and its key",
        ),
        (vec!["--tls-cert".to_owned(), text(&key), "--tls-key".to_owned(), text(&key)], "no certificate"),
        (vec!["--tls-cert".to_owned(), "/nowhere".to_owned(), "--tls-key".to_owned(), text(&key)], "/nowhere"),
    ] {
        let mut command = binary(&["serve", "--store", "memory:", "--listen", "127.0.0.1:0"]);
        let output = ended(command.args(&arguments));
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && said.lines().count() == 1 && said.contains(why), "{arguments:?}: {said}");
    }
}
