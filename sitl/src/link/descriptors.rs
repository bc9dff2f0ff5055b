//! Descriptors of the process: connections must leave some to files.

/// Descriptors that are left to files, unless the process may have few.
#[cfg(unix)]
pub(super) const RESERVED: u64 = 64;

/// Whether a connection has one of the last descriptors that the process may open: the system gives the lowest that is free.
#[cfg(unix)]
pub fn is_one_of_the_last(connection: &impl std::os::fd::AsRawFd) -> bool {
    use rustix::process::{Resource, getrlimit};
    let Some(limit) = getrlimit(Resource::Nofile).current else { return false };
    let reserved = RESERVED.min(limit / 4);
    u64::try_from(connection.as_raw_fd()).is_ok_and(|number| number >= limit - reserved)
}

/// Elsewhere there is no such limit.
#[cfg(not(unix))]
pub fn is_one_of_the_last(_connection: &std::net::TcpStream) -> bool {
    false
}
