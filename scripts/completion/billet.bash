# SPDX-License-Identifier: LGPL-2.1-or-later
# Completion of billet for bash: options, scenes, checkpoints and folders.
# shellcheck shell=bash disable=SC2207 # names are split at line ends alone

_billet() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
  local IFS=$'\n'
  compopt -o filenames 2>/dev/null
  case $previous in
    --restart)
      COMPREPLY=($(compgen -d -- "$current") $(compgen -f -X '!*.h5' -- "$current"))
      return
      ;;
    --output)
      COMPREPLY=($(compgen -d -- "$current"))
      return
      ;;
    --set | --ranks)
      return
      ;;
  esac
  if [[ $current == -* ]]; then
    compopt +o filenames 2>/dev/null
    COMPREPLY=($(compgen -W $'--certify\n--check\n--force\n--help\n--json\n--list\n--manual\n--markdown\n--new\n--output\n--preview\n--print-diagnostics\n--print-parameters\n--quiet\n--ranks\n--restart\n--set\n--update-scene\n--version' -- "$current"))
  else
    COMPREPLY=($(compgen -d -- "$current") $(compgen -f -X '!*.prm' -- "$current"))
  fi
}

complete -F _billet billet
