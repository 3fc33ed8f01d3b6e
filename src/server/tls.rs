//! TLS: the certificate and the private key of the service, which can be replaced while it runs.

use std::io;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;

use parking_lot::RwLock;
use rustls::ServerConfig;
use rustls::crypto::ring;
use rustls::pki_types::pem::PemObject as _;
use rustls::pki_types::{CertificateDer, PrivateKeyDer};
use tokio::io::{AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _};
use tokio::net::TcpStream;
use tokio_rustls::{TlsAcceptor, TlsConnector};

use crate::unverified_tls;

/// The files of a certificate, as PEM.
#[derive(Clone, Debug)]
pub struct TlsFiles {
    /// The certificate, followed by those of its authorities.
    pub certificate: PathBuf,
    /// Its private key.
    pub key: PathBuf,
}

/// Accepts TLS connections. Clones share the certificate.
#[derive(Clone)]
pub struct Tls {
    files: TlsFiles,
    // Locked for a clone of the handle, and never across an await.
    acceptor: Arc<RwLock<TlsAcceptor>>,
}

impl Tls {
    /// Reads the files.
    ///
    /// # Errors
    /// Which file cannot be read, or that the key is not that of the certificate.
    pub fn open(files: TlsFiles) -> Result<Tls, String> {
        let acceptor = Arc::new(RwLock::new(read(&files)?));
        Ok(Tls { files, acceptor })
    }

    /// Reads the files again, for the connections to come.
    ///
    /// # Errors
    /// As [`Tls::open`]; the certificate stays as it was then.
    pub fn reload(&self) -> Result<(), String> {
        let acceptor = read(&self.files)?;
        *self.acceptor.write() = acceptor;
        Ok(())
    }

    /// What accepts a connection now.
    pub(crate) fn acceptor(&self) -> TlsAcceptor {
        self.acceptor.read().clone()
    }
}

fn read(TlsFiles { certificate, key }: &TlsFiles) -> Result<TlsAcceptor, String> {
    let chain = CertificateDer::pem_file_iter(certificate).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let chain = chain.map_err(|error| format!("no certificate can be read from {}: {error}", certificate.display()))?;
    let private = PrivateKeyDer::from_pem_file(key);
    let private = private.map_err(|error| format!("no private key can be read from {}: {error}", key.display()))?;
    let config = ServerConfig::builder_with_provider(Arc::new(ring::default_provider()))
        .with_safe_default_protocol_versions()
        .and_then(|config| config.with_no_client_auth().with_single_cert(chain, private));
    let mut config = config.map_err(|error| {
        format!("{} and {} are not a certificate and its key: {error}", certificate.display(), key.display())
    })?;
    config.alpn_protocols = vec![b"http/1.1".to_vec()];
    Ok(TlsAcceptor::from(Arc::new(config)))
}

/// Calls `/healthz` of a service on this machine, with TLS whatever its certificate is.
///
/// # Errors
/// Why it is not healthy.
pub async fn healthz(address: SocketAddr, with_tls: bool) -> Result<(), String> {
    let config = Arc::new(unverified_tls::config()?);
    let call = async {
        let stream = TcpStream::connect(address).await?;
        if with_tls {
            status(TlsConnector::from(config).connect(address.ip().into(), stream).await?).await
        } else {
            status(stream).await
        }
    };
    match call.await {
        Ok(status) if status == "HTTP/1.1 200" => Ok(()),
        Ok(status) => Err(status),
        Err(error) => Err(error.to_string()),
    }
}

/// The version and the status that `/healthz` answers with.
async fn status(mut stream: impl AsyncRead + AsyncWrite + Unpin) -> io::Result<String> {
    stream.write_all(b"GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n").await?;
    let mut status = [0; b"HTTP/1.1 200".len()];
    stream.read_exact(&mut status).await?;
    Ok(String::from_utf8_lossy(&status).into_owned())
}
