#!/usr/bin/env python3
"""Runs the vectorised kernels of batch simulations on an emulated processor and checks that every bit of the metrics
equals that of this machine (lane_bits.cpp).
usage: other_processor.py neon|avx512
  neon    a 64-bit ARM emulated by qemu-user, compared with the AVX2 kernel
  avx512  a Skylake-X emulated by Bochs with a Linux kernel of Debian, compared with the AVX2 kernel; also tests every operation of
          lanes (lane_operations_test.cpp)
The exit code is 77 if the emulator (scripts/setup all installs it) or AVX2 on this machine is missing."""
import gzip
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
LIB = ROOT / "lib/awmr"
SKIPPED = 77
LONGEST_S = 900
OPTIONS = ["-std=c++20", "-O2", "-DNDEBUG", "-ffp-contract=off", "-DFMT_HEADER_ONLY", f"-I{ROOT / 'lib'}",
           "-isystem", "/usr/include/eigen3"]
# Instruction-set flags as in lib/awmr/simulate/CMakeLists.txt. Other optimisation flags may differ, because the order of
# instructions does not affect the results.
KERNELS = {"avx2": ["-mavx2", "-mfma"], "avx512": ["-mavx512f", "-mfma"], "neon": []}
KERNEL_OPTIONS = ["-fno-tree-slp-vectorize"]
# Sources that batches need, without file readers and their libraries.
PARTS = ["core/error", "core/option_text", "core/random", "core/text", "identify/logs/simulation/sensitivity_kernel", "model/family",
         "model/model", "model/observer_rate", "model/parameters", "model/rest_speed", "model/vehicle", "simulate/batch",
         "simulate/conditions", "simulate/disturbance", "simulate/metrics", "simulate/passage", "simulate/physics",
         "simulate/run_columns", "simulate/scenario", "simulate/scenario_guidance", "simulate/sensing", "simulate/simulate"]
BOCHS = """\
config_interface: textconfig
display_library: rfb, options="timeout=0"
cpu: model=corei7_skylake_x, ips=100000000
memory: guest=512, host=512
romimage: file=/usr/share/bochs/BIOS-bochs-latest
vgaromimage: file=/usr/share/bochs/VGABIOS-lgpl-latest
ata0-master: type=cdrom, path={folder}/boot.iso, status=inserted
boot: cdrom
com1: enabled=1, mode=file, dev={folder}/serial.txt
log: {folder}/bochs.log
panic: action=fatal
plugin_ctrl: speaker=0, sb16=0, es1370=0
sound: waveoutdrv=dummy, waveindrv=dummy, midioutdrv=dummy
"""
# Without xsavec and xsaves Linux saves registers in the standard layout: the emulated processor reports a wrong size for the
# compacted layout.
BOOT = """\
DEFAULT linux
LABEL linux
  KERNEL vmlinuz
  INITRD initrd.gz
  APPEND console=ttyS0 quiet loglevel=1 clearcpuid=xsavec,xsaves
"""
INIT = """\
#!/bin/busybox sh
/bin/busybox mount -t devtmpfs none /dev
exec >/dev/ttyS0 2>&1
echo BEGIN
/bin/lane_operations && /bin/lane_bits avx512
echo "END $?"
/bin/busybox sleep 3 # until the last of it is sent
/bin/busybox poweroff -f
"""


def run(words, **more):
    return subprocess.run([str(word) for word in words], check=True, **more)


def output_of(words, **more):
    return run(words, stdout=subprocess.PIPE, text=True, timeout=LONGEST_S, **more).stdout


def built(folder, compiler, kernels):
    """Builds lane_bits with these kernels for the processor of the compiler; returns the path of the program."""
    folder.mkdir()
    jobs = [(LIB / f"{part}.cpp", []) for part in PARTS] + [(HERE / "lane_bits.cpp", [])]
    jobs += [(LIB / "simulate/simd/kernels.cpp", [f"-DAWMR_HAS_{kernel.upper()}" for kernel in kernels])]
    jobs += [(LIB / f"simulate/simd/kernel_{kernel}.cpp", KERNELS[kernel] + KERNEL_OPTIONS) for kernel in kernels]
    launcher = ["ccache"] if shutil.which("ccache") else []
    for source, options in jobs:
        run([*launcher, compiler, *OPTIONS, *options, "-c", source, "-o", folder / f"{source.stem}.o"])
    run([compiler, "-static", *folder.glob("*.o"), "-o", folder / "lane_bits"])
    return folder / "lane_bits"


def on_arm(folder, _):
    return output_of(["qemu-aarch64", built(folder / "arm", "aarch64-linux-gnu-g++", ["neon"]), "neon"])


def linux_image(folder):
    """Debian's smallest kernel; it is only used in the emulator."""
    package = output_of(["apt-cache", "depends", "linux-image-cloud-amd64"]).split("Depends: ")[1].split()[0]
    run(["apt-get", "download", "-qq", package], cwd=folder, stderr=subprocess.DEVNULL)
    run(["dpkg-deb", "-x", next(folder.glob("*.deb")), folder / "linux"])
    return next((folder / "linux/boot").glob("vmlinuz-*"))


def boot_disc(folder, programs):
    """A disc image that boots Linux, runs the programs and powers off."""
    root, disc = folder / "root", folder / "disc"
    for part in (root / "bin", root / "dev", disc):
        part.mkdir(parents=True)
    for program in [pathlib.Path(shutil.which("busybox")), *programs]:
        shutil.copy(program, root / "bin" / program.name)
    (root / "init").write_text(INIT)
    (root / "init").chmod(0o755)
    names = "\n".join(str(path.relative_to(root)) for path in sorted(root.rglob("*")))
    archive = run(["busybox", "cpio", "-o", "-H", "newc"], cwd=root, input=names.encode(), stdout=subprocess.PIPE,
                  stderr=subprocess.DEVNULL).stdout
    (disc / "initrd.gz").write_bytes(gzip.compress(archive, 1))
    (disc / "isolinux.cfg").write_text(BOOT)
    shutil.copy(linux_image(folder), disc / "vmlinuz")
    shutil.copy("/usr/lib/ISOLINUX/isolinux.bin", disc)
    shutil.copy("/usr/lib/syslinux/modules/bios/ldlinux.c32", disc)
    run(["xorriso", "-as", "mkisofs", "-quiet", "-o", folder / "boot.iso", "-b", "isolinux.bin", "-c", "boot.cat",
         "-no-emul-boot", "-boot-load-size", "4", "-boot-info-table", disc], stderr=subprocess.DEVNULL)


def on_skylake(folder, bits):
    operations = folder / "lane_operations"
    run(["g++", *OPTIONS, *KERNELS["avx512"], f"-I{ROOT / 'tests'}", "-static", HERE.parent / "lane_operations_test.cpp", "-o", operations])
    boot_disc(folder, [bits, operations])
    (folder / "bochsrc").write_text(BOCHS.format(folder=folder))
    (folder / "commands").write_text("c\n")  # Debian's Bochs starts in its debugger; "c" continues
    with open(folder / "bochs.txt", "w", encoding="utf-8") as told:
        subprocess.run(["bochs", "-q", "-f", "bochsrc", "-rc", "commands"], cwd=folder, stdin=subprocess.DEVNULL,
                       stdout=told, stderr=told, timeout=LONGEST_S, check=False)
    serial = (folder / "serial.txt").read_text(errors="replace").replace("\r", "")
    if "END 0" not in serial:
        sys.exit(f"the programs on the emulated processor did not end with exit code 0:\n{serial[-2000:]}")
    print(serial.split("BEGIN\n")[1].split("\nheading")[0])
    return "heading" + serial.split("\nheading", 1)[1].split("END 0")[0]


def main():
    asked = sys.argv[1]
    needed = {"neon": ["aarch64-linux-gnu-g++", "qemu-aarch64"], "avx512": ["bochs", "busybox", "xorriso", "apt-get"]}[asked]
    lacking = [program for program in needed if not shutil.which(program)]
    if lacking or "avx2" not in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8"):
        print("skipped: this machine does not have", ", ".join(lacking) or "AVX2")
        return SKIPPED
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        bits = built(folder / "here", "g++", ["avx2", "avx512"])
        here = output_of([bits, "avx2"]).splitlines()
        there = (on_arm if asked == "neon" else on_skylake)(folder, bits).splitlines()
    different = [pair for pair in zip(here, there) if pair[0] != pair[1]]
    print(f"{asked}: {len(there)} of {len(here)} lines, {len(different)} of them different from this machine's AVX2 kernel")
    for one, other in different[:3]:
        print(f"  here:  {one}\n  there: {other}")
    return 0 if len(here) == len(there) and here and not different else 1


if __name__ == "__main__":
    sys.exit(main())
