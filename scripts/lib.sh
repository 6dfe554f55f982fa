# What scripts/demo and scripts/test share, which source this: where cargo builds, and system packages.
# shellcheck shell=bash

# shellcheck disable=SC2034
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# Everything is built in one folder outside the checkout, so that all checkouts and CI share one compiled Bevy.
# CARGO_TARGET_DIR names another; plain `cargo` commands use ./target unless it is set for them too.
export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-${XDG_CACHE_HOME:-$HOME/.cache}/bevy_verdure/target}

is_linux() {
    [[ $(uname -s) == Linux ]]
}

fail() {
    echo "error: $*" >&2
    exit 1
}

# Puts cargo on the PATH, or says how to get it.
need_cargo() {
    command -v cargo >/dev/null || export PATH="$PATH:$HOME/.cargo/bin"
    command -v cargo >/dev/null ||
        fail "cargo is not on the PATH. Install Rust (see https://rustup.rs), then run this again"
}

# Debian packages that are not there.
missing=()

# need PACKAGE COMMAND...: notes the package as missing where the command fails.
need() {
    local package=$1
    shift
    "$@" >/dev/null 2>&1 || missing+=("$package")
}

has_library() {
    local folder
    for folder in /usr/lib/*-linux-* /usr/lib /usr/lib64 /usr/local/lib; do
        if [[ -e $folder/$1 ]]; then return; fi
    done
    return 1
}

# Any driver will do, that of a GPU or Mesa's software one.
has_vulkan_driver() {
    [[ -n ${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-} ]] ||
        compgen -G '/usr/share/vulkan/icd.d/*.json' || compgen -G '/etc/vulkan/icd.d/*.json'
}

# What building and drawing take: a C++ compiler, which links too, and Vulkan.
need_build_packages() {
    local cxx=${CXX:-c++}
    need g++ command -v cc
    need g++ command -v "${cxx%% *}"
    need mesa-vulkan-drivers has_vulkan_driver
    need libvulkan1 has_library libvulkan.so.1
}

# What a window takes besides; its libraries are opened when the program runs.
need_window_packages() {
    need libx11-6 has_library libX11.so.6
    need libx11-xcb1 has_library libX11-xcb.so.1
    need libxcursor1 has_library libXcursor.so.1
    need libxi6 has_library libXi.so.6
    need libxkbcommon-x11-0 has_library libxkbcommon-x11.so.0
}

as_root() {
    if [[ $(id -u) -eq 0 ]]; then "$@"; else sudo -n "$@"; fi
}

apt_get() {
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=120 "$@"
}

# Installs the missing packages, or prints the line that does and stops.
install_missing() {
    if [[ ${#missing[@]} -eq 0 ]]; then return; fi
    local packages line
    packages=$(printf '%s\n' "${missing[@]}" | sort -u | tr '\n' ' ')
    packages=${packages% }
    if ! command -v apt-get >/dev/null; then
        echo "note: if what follows fails, install what Debian calls: $packages" >&2
        return
    fi
    line="apt-get update && apt-get install -y --no-install-recommends $packages"
    if [[ $(id -u) -ne 0 ]]; then line="sudo sh -c '$line'"; fi
    if ! as_root true 2>/dev/null; then
        fail "system packages are missing. Run this line, then this script again:"$'\n\n'"    $line"$'\n'
    fi
    echo "Installing $packages"
    # Where one of several sources is out of reach, what is needed may still be had.
    apt_get update -q || true
    read -ra missing <<<"$packages"
    apt_get install -q -y --no-install-recommends "${missing[@]}" ||
        fail "apt-get failed. See to what it says above, or run this line yourself:"$'\n\n'"    $line"$'\n'
}

# Without a window, pictures are drawn with Vulkan, unless WGPU_BACKEND says otherwise.
draw_with_vulkan() {
    if is_linux; then export WGPU_BACKEND=${WGPU_BACKEND:-vulkan}; fi
}
