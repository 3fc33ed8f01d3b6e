//! A small disk for a process under test.

use std::fs::File;
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use tempfile::{TempDir, tempdir};

/// A disk of its own kind: a tmpfs in a mount namespace, which a process keeps alive. No rights are needed where user
/// namespaces are allowed.
pub struct SmallDisk {
    keeper: Child,
    /// Where it is mounted, for those who see it.
    pub folder: TempDir,
}

impl SmallDisk {
    /// A disk of `size` bytes.
    pub fn new(size: usize) -> SmallDisk {
        let folder = tempdir().unwrap();
        let script = r#"mount -t tmpfs -o size="$1" tmpfs "$0" && echo mounted && exec sleep 100000"#;
        let mut keeper = Command::new("unshare")
            .args(["--map-root-user", "--mount", "sh", "-c", script])
            .arg(folder.path())
            .arg(size.to_string())
            .stdout(Stdio::piped())
            .spawn()
            .expect("unshare (util-linux) is needed to mount a small disk");
        let mut line = String::new();
        BufReader::new(keeper.stdout.take().unwrap()).read_line(&mut line).unwrap();
        assert_eq!(line.trim(), "mounted", "this test mounts a small disk, and may not");
        SmallDisk { keeper, folder }
    }

    /// The prefix of a command that is to see the disk.
    pub fn entrance(&self) -> Vec<String> {
        let keeper = self.keeper.id().to_string();
        ["nsenter", "--preserve-credentials", "--user", "--mount", "--target", &keeper].map(str::to_owned).to_vec()
    }

    /// A file on the disk, as it is seen from outside.
    pub fn file(&self, name: &str) -> PathBuf {
        let root = PathBuf::from(format!("/proc/{}/root", self.keeper.id()));
        root.join(self.folder.path().strip_prefix(Path::new("/")).unwrap()).join(name)
    }

    /// Leaves this many bytes free.
    pub fn fill(&self, room: u64) {
        let mut filler = File::create(self.file("filler")).unwrap();
        while filler.write_all(&[1; 4096]).is_ok() {}
        let length = filler.metadata().unwrap().len();
        filler.set_len(length - room).unwrap();
    }

    /// Gives the room back.
    pub fn clear(&self) {
        std::fs::remove_file(self.file("filler")).unwrap();
    }
}

impl Drop for SmallDisk {
    fn drop(&mut self) {
        let _ = self.keeper.kill();
        let _ = self.keeper.wait();
    }
}
