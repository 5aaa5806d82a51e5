#!/bin/sh
# Starts heliodon from its bundle. lib/base is used only where this system lacks one of the base libraries.
here=$(dirname "$(readlink -f "$0")")
program=$here/../libexec/heliodon
if LD_TRACE_LOADED_OBJECTS=1 "$program" 2>&1 | grep -q 'not found'; then
    LD_LIBRARY_PATH=$here/../lib/base${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
    export LD_LIBRARY_PATH
fi
exec "$program" "$@"
