//! Ports for servers that must be told one.

use tokio::net::TcpSocket;

/// A free port, and what keeps it: until this is dropped the system gives it to nobody who asks for any, but a server
/// that reuses addresses can listen there, time after time.
pub fn reserve() -> (u16, TcpSocket) {
    let socket = TcpSocket::new_v4().unwrap();
    socket.set_reuseaddr(true).unwrap();
    socket.bind("127.0.0.1:0".parse().unwrap()).unwrap();
    (socket.local_addr().unwrap().port(), socket)
}
