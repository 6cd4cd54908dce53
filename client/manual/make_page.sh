#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# A manual page from what a program says of itself: --help, and --help of each verb. To stdout.
# Usage: make_page.sh PROGRAM NAME VERSION "what it is in a few words" [DATE, yyyy-mm-dd]
set -eu
program=$1 name=$2 version=$3 what=$4 date=${5:-}

# Text as it stands: backslashes doubled, and no line taken for a request to the formatter.
as_it_stands() {
  printf '.nf\n'
  sed -e 's/\\/\\e/g' -e 's/-/\\-/g' -e "s/^[.']/\\\\\&&/"
  printf '.fi\n'
}
section() { printf '.SH %s\n' "$1"; }

help=$("$program" --help)
printf '.TH %s 1 "%s" "%s %s"\n' "$(printf %s "$name" | tr '[:lower:]' '[:upper:]')" "$date" skinframe "$version"
section NAME
printf '%s \\- %s\n' "$(printf %s "$name" | sed 's/-/\\-/g')" "$what"
section DESCRIPTION
printf '%s\n' "$help" | as_it_stands
verbs=$(printf '%s\n' "$help" | awk '/^Subcommands:/ {on = 1; next} /^[^ ]/ {on = 0} on && /^  [a-z]/ {print $1}')
if [ -n "$verbs" ]; then
  section VERBS
  for verb in $verbs; do
    printf '.SS "%s %s"\n' "$name" "$verb"
    "$program" "$verb" --help | as_it_stands
  done
fi
