#!/usr/bin/env bash
# pkg_config.sh COMPILER PREFIX SOURCE PROGRAM: builds and runs SOURCE with the flags that pkg-config gives.
set -euo pipefail
compiler=$1 prefix=$2 source=$3 program=$4

PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name carom.pc)")
export PKG_CONFIG_PATH
read -ra flags <<< "$(pkg-config --cflags --libs carom)"
mkdir -p "$(dirname "$program")"
"$compiler" -std=c++20 "$source" "${flags[@]}" -o "$program"
"$program"
