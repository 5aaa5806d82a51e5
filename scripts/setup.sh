#!/bin/bash
# Installs what Heliodon needs and this system lacks. Usage: scripts/setup.sh build|test
# Asks for sudo at most once and leaves apt's configuration as it is. Everything it says goes to standard error.
set -euo pipefail
exec 1>&2

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$root/scripts/packages.sh"
scratch=

die() { echo "setup: $*"; exit 1; }

make_scratch() {
    scratch=$(mktemp -d)
    chmod 755 "$scratch"  # apt reads its sources as another user
    trap 'rm -rf "$scratch"' EXIT
}

codename() { (. /etc/os-release && echo "${VERSION_CODENAME:-}"); }

wanted_packages() {
    printf '%s\n' "${build_packages[@]}"
    if [ "$1" = test ]; then printf '%s\n' "${test_packages[@]}"; fi
}

missing_packages() {
    local package
    wanted_packages "$1" | while read -r package; do
        dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || echo "$package"
    done
}

mesa_is_old() {
    local version
    version=$(dpkg-query -W -f '${Version}' mesa-vulkan-drivers 2>/dev/null) || return 0
    dpkg --compare-versions "$version" lt "$mesa_minimum"
}

vma_is_missing() {
    [ ! -e /usr/include/vk_mem_alloc.h ] && [ ! -e /usr/include/vma/vk_mem_alloc.h ] &&
        [ ! -e "$root/build/deps/include/vk_mem_alloc.h" ]
}

# The options that the source entry at FILE:LINE of apt's configuration gives, as a one-line entry has them.
source_options() {
    local file=${1%:*}
    case $file in
        *.sources) awk -v entry="${1##*:}" 'BEGIN { RS = "" } NR == entry' "$file" |
            sed -nE 's/^Signed-By:[[:space:]]*(\/[^[:space:]]+).*/signed-by=\1/p; s/^Trusted:[[:space:]]*yes.*/trusted=yes/p' ;;
        *) sed -n "${1##*:}p" "$file" | grep -oE '(signed-by|trusted)=[^] ]+' ;;
    esac | tr '\n' ' '
}

# Writes apt sources for SUITE to $scratch/parts: the same mirror and keys as this system's own sources use for
# its release. apt itself is asked what those are.
add_suite() {
    local suite=$1 uri entry options
    mkdir -p "$scratch/parts"
    while IFS='|' read -r uri entry; do
        options=$(source_options "$entry" || true)
        echo "deb [arch=$(dpkg --print-architecture) $options] $uri $suite main"
    done < <(apt-get indextargets --format '$(ORIGIN)|$(REPO_URI)|$(SOURCESENTRY)' \
        'Created-By: Packages' "Release: $(codename)" 'Component: main' |
        sed -n 's/^Debian|//p' | sort -u | head -n 1) > "$scratch/parts/$suite.list"
    [ -s "$scratch/parts/$suite.list" ] || die "apt's sources name no Debian mirror for $(codename)"
}

install_as_root() {
    export DEBIAN_FRONTEND=noninteractive
    local packages=("$@")
    local apt=(apt-get -q -y -o Dpkg::Use-Pty=0 --no-install-recommends)
    "${apt[@]}" update || echo "setup: some package lists could not be refreshed; going on with what there is"
    if [ ${#packages[@]} -gt 0 ]; then
        "${apt[@]}" install "${packages[@]}"
    fi
    if mesa_is_old; then
        local suite
        suite=$(codename)-backports
        if apt-get indextargets --format '$(RELEASE)' 'Created-By: Packages' | grep -qx "$suite"; then
            echo "setup: taking Mesa ≥ $mesa_minimum from $suite"
        else
            echo "setup: taking Mesa ≥ $mesa_minimum from $suite, for this once (apt's sources stay as they are)"
            make_scratch
            add_suite "$suite"
            cp /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources "$scratch/parts/" 2>/dev/null || true
            mkdir -p "$scratch/lists/partial"
            apt+=(-o Dir::Etc::sourceparts="$scratch/parts" -o Dir::State::Lists="$scratch/lists")
            "${apt[@]}" update || true
        fi
        "${apt[@]}" install -t "$suite" mesa-vulkan-drivers
        if mesa_is_old; then die "no Mesa ≥ $mesa_minimum to be had from $suite"; fi
    fi
}

# Unpacks the header-only Vulkan Memory Allocator of the next suite into build/deps. Needs no root.
unpack_vma() {
    local suite=trixie
    echo "setup: unpacking the header of Vulkan Memory Allocator from $suite into build/deps"
    [ -n "$scratch" ] || make_scratch
    rm -rf "$scratch/parts"
    add_suite "$suite"
    mkdir -p "$scratch/vma/lists/partial" "$scratch/vma/cache/archives/partial"
    local apt=(apt-get -q -o Dir::Etc::sourcelist=/dev/null -o Dir::Etc::sourceparts="$scratch/parts"
        -o Dir::State::Lists="$scratch/vma/lists" -o Dir::Cache="$scratch/vma/cache"
        -o APT::Sandbox::User="$(id -un)")
    "${apt[@]}" update
    (cd "$scratch/vma" && "${apt[@]}" download libvulkan-memory-allocator-dev)
    dpkg -x "$scratch"/vma/libvulkan-memory-allocator-dev_*.deb "$scratch/vma/root"
    mkdir -p "$root/build/deps/include"
    cp "$scratch/vma/root/usr/include/vk_mem_alloc.h" "$root/build/deps/include/"
}

main() {
    if [ "${1:-}" = install-as-root ]; then
        shift
        install_as_root "$@"
        return
    fi
    local mode=${1:-build}
    if ! command -v apt-get >/dev/null; then
        echo "setup: no apt here: the packages of scripts/packages.sh must be there already"
        return
    fi
    local missing
    mapfile -t missing < <(missing_packages "$mode")
    # Debian 13 packages the Vulkan Memory Allocator itself.
    if vma_is_missing && [ "$(codename)" != bookworm ]; then missing+=(libvulkan-memory-allocator-dev); fi
    if [ ${#missing[@]} -gt 0 ] || mesa_is_old; then
        echo "setup: installing ${missing[*]:-Mesa ≥ $mesa_minimum}"
        if [ "$(id -u)" = 0 ]; then
            bash "$0" install-as-root "${missing[@]}"
        elif command -v sudo >/dev/null; then
            sudo bash "$0" install-as-root "${missing[@]}"
        else
            die "needs root to install: ${missing[*]}"
        fi
    fi
    if vma_is_missing; then unpack_vma; fi
}

main "$@"
