//! The pipes of the host, out of the FMU's reach: what it prints goes to the standard error stream, what it reads is empty.

use std::fs::File;
use std::io;

unsafe extern "C" {
    fn importer_buffer_lines();
}

/// Requests and responses.
pub(super) struct Streams {
    pub(super) requests: File,
    pub(super) responses: File,
}

impl Streams {
    /// Takes them from the standard streams.
    ///
    /// # Errors
    /// Those of the system.
    pub(super) fn take() -> io::Result<Self> {
        let streams = taken()?;
        // SAFETY: nothing has been written to C's standard output in this process.
        unsafe { importer_buffer_lines() };
        Ok(streams)
    }
}

#[cfg(unix)]
fn taken() -> io::Result<Streams> {
    use std::os::fd::AsFd;
    let requests = File::from(io::stdin().as_fd().try_clone_to_owned()?);
    let responses = File::from(io::stdout().as_fd().try_clone_to_owned()?);
    // SAFETY: both descriptors are open; nobody else in this process uses the replaced ones.
    let replaced = unsafe {
        use std::os::fd::AsRawFd;
        libc::dup2(File::open("/dev/null")?.as_raw_fd(), 0) >= 0 && libc::dup2(2, 1) >= 0
    };
    if replaced { Ok(Streams { requests, responses }) } else { Err(io::Error::last_os_error()) }
}

#[cfg(windows)]
fn taken() -> io::Result<Streams> {
    use std::os::windows::io::AsHandle;
    let requests = File::from(io::stdin().as_handle().try_clone_to_owned()?);
    let responses = File::from(io::stdout().as_handle().try_clone_to_owned()?);
    // SAFETY: standard descriptors of the C library; nobody else in this process uses the replaced one.
    if unsafe { libc::dup2(2, 1) } < 0 {
        return Err(io::Error::last_os_error());
    }
    Ok(Streams { requests, responses })
}
