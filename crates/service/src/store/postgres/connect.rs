//! Where the database is, and how connections to it are protected.
//!
//! The URL may hold a password, so that neither it nor a part of it is ever shown: [`ConnectTarget::address`] has host
//! and database alone.

use std::sync::Arc;

use percent_encoding::percent_decode_str;
use rustls::crypto::ring;
use rustls::pki_types::CertificateDer;
use rustls::pki_types::pem::PemObject as _;
use rustls::{ClientConfig, RootCertStore};
use tokio_postgres::config::Host;
use tokio_postgres::tls::MakeTlsConnect;
use tokio_postgres::{Client, Config, Connection, Error, Socket};
use tokio_postgres_rustls::MakeRustlsConnect;

use super::sql;
use crate::unverified_tls;

/// What counts unless the URL says otherwise: connecting may take 3 s, and sent bytes may stay unconfirmed for 10 s; a
/// connection that has been silent for 10 s is tested 3 times, 2 s apart.
const DEFAULTS: &str = "application_name=stickslip&connect_timeout=3&tcp_user_timeout=10&keepalives_idle=10\
    &keepalives_interval=2&keepalives_retries=3";

/// A connection whose messages have yet to be driven.
pub(super) type Driver = Connection<Socket, <MakeRustlsConnect as MakeTlsConnect<Socket>>::Stream>;

#[derive(Clone)]
pub(super) struct ConnectTarget {
    pub(super) config: Config,
    pub(super) tls: MakeRustlsConnect,
}

impl ConnectTarget {
    pub(super) fn parse(url: &str) -> Result<ConnectTarget, String> {
        let (url, verification) = split_tls_options(url)?;
        let config: Config = url.parse().map_err(|error| error_chain(&error))?;
        if config.get_hosts().is_empty() && config.get_hostaddrs().is_empty() {
            return Err("the URL names no host".to_owned());
        }
        Ok(ConnectTarget { config, tls: MakeRustlsConnect::new(verification.config()?) })
    }

    /// The database in words, without the password.
    pub(super) fn address(&self) -> String {
        let hosts = self.config.get_hosts().iter().map(|host| match host {
            Host::Tcp(name) => name.clone(),
            Host::Unix(path) => path.display().to_string(),
        });
        let hosts: Vec<String> = hosts.collect();
        let database = self.config.get_dbname().or(self.config.get_user()).unwrap_or_default();
        format!("{}/{database}", hosts.join(","))
    }

    /// Connects, and sets the bounds for statements.
    pub(super) async fn connect(&self) -> Result<(Client, Driver), Error> {
        self.config.connect(self.tls.clone()).await
    }

    /// Connects, leaves the connection to a task of its own, and sets the bounds for statements.
    pub(super) async fn open(&self) -> Result<Client, Error> {
        let (client, driver) = self.connect().await?;
        // It ends when the client is dropped or the connection is lost, which the next statement reports.
        tokio::spawn(driver);
        client.batch_execute(sql::PREPARE_CONNECTION).await?;
        Ok(client)
    }
}

/// An error of the driver with its causes: alone it says little.
pub(super) fn error_chain(error: &Error) -> String {
    causes(error).fold(error.to_string(), |text, cause| format!("{text}: {cause}"))
}

/// The causes of an error, from the nearest on.
pub(super) fn causes(error: &Error) -> impl Iterator<Item = &(dyn std::error::Error + 'static)> {
    std::iter::successors(std::error::Error::source(error), |cause| cause.source())
}

/// Which certificate authorities are trusted.
enum Verification {
    /// None is checked: the connection is encrypted, as libpq does for `prefer` and `require`.
    None,
    /// The certificate authorities of the system.
    System,
    /// The certificate authorities in a PEM file.
    File(String),
}

/// Removes from a URL the TLS options that the driver does not support, and adds the default of others.
fn split_tls_options(url: &str) -> Result<(String, Verification), String> {
    let (base, query) = url.split_once('?').unwrap_or((url, ""));
    // The last one of a name counts.
    let (mut rest, mut root, mut full) = (vec![DEFAULTS], None, false);
    for option in query.split('&').filter(|option| !option.is_empty()) {
        match option.split_once('=') {
            Some(("sslmode", "verify-full")) => {
                full = true;
                rest.push("sslmode=require");
            }
            Some(("sslmode", "verify-ca" | "allow")) => {
                return Err("sslmode may be disable, prefer, require or verify-full".to_owned());
            }
            Some(("sslrootcert", path)) => root = Some(percent_decode_str(path).decode_utf8_lossy().into_owned()),
            _ => rest.push(option),
        }
    }
    let verification = match root {
        Some(_) if !full => return Err("sslrootcert needs sslmode=verify-full".to_owned()),
        Some(path) if path != "system" => Verification::File(path),
        _ if full => Verification::System,
        _ => Verification::None,
    };
    Ok((format!("{base}?{}", rest.join("&")), verification))
}

impl Verification {
    fn config(&self) -> Result<ClientConfig, String> {
        let Some(roots) = self.roots()? else {
            return unverified_tls::config();
        };
        let builder = ClientConfig::builder_with_provider(Arc::new(ring::default_provider()));
        let builder = builder.with_safe_default_protocol_versions().map_err(|error| format!("TLS: {error}"))?;
        Ok(builder.with_root_certificates(roots).with_no_client_auth())
    }

    fn roots(&self) -> Result<Option<RootCertStore>, String> {
        let certificates = match self {
            Verification::None => return Ok(None),
            Verification::System => rustls_native_certs::load_native_certs().certs,
            Verification::File(path) => {
                let read = CertificateDer::pem_file_iter(path).and_then(Iterator::collect);
                read.map_err(|error| format!("sslrootcert {path}: {error}"))?
            }
        };
        let mut roots = RootCertStore::empty();
        let (added, _) = roots.add_parsable_certificates(certificates);
        if added == 0 {
            return Err("no certificate authority was found to verify the server".to_owned());
        }
        Ok(Some(roots))
    }
}
