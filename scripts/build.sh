# Sourced by ./run and ./test: set-up and build, both silent on standard output.

# prepare build|test TARGET...: installs what is missing (skipped while nothing changed), configures and
# builds release. A second start takes well under a second.
prepare() {
    local mode=$1
    shift
    local stamp=$root/build/setup-$mode.stamp
    local now
    now=$(cat "$root/scripts/packages.sh" "$root/scripts/setup.sh" /etc/os-release | cksum)
    {
        if [ ! -e "$stamp" ] || [ "$(cat "$stamp")" != "$now" ]; then
            "$root/scripts/setup.sh" "$mode"
            mkdir -p "$root/build"
            echo "$now" > "$stamp"
        fi
        if [ ! -e "$root/build/release/build.ninja" ]; then
            cmake -S "$root" --preset release
        fi
        # The first build shows how far it is; later ones are silent unless something is wrong. One at a time.
        local build=(flock "$root/build/lock" ninja -C "$root/build/release")
        if [ -e "$root/build/release/bin/heliodon" ]; then
            "${build[@]}" --quiet "$@" | sed '/^ninja: no work to do/d'
        else
            "${build[@]}" "$@"
        fi
    } >&2
}
