# Completion of voussoir's arguments in bash, from the output of the program. Installed for
# package bash-completion; or: source source/completion.bash

# Paths of all entries, "Section/Entry=", of a case or of every class.
_voussoir_entries() { # program, case
  "$1" ${2:+"$2"} --defaults short 2>/dev/null | awk '
    $1 == "subsection" { sub(/^ *subsection */, ""); path[++depth] = $0 "/" }
    $1 == "end"        { --depth }
    $1 == "set"        { sub(/^ *set */, ""); sub(/ *=.*/, "")
                         line = ""
                         for (i = 1; i <= depth; ++i) line = line path[i]
                         print line $0 "=" }'
}

# Words that may follow an option, from its help: "... as description, json, ... xml".
_voussoir_choices() { # program, option
  "$1" --help | awk -v option="$2" '$1 == option { sub(/.*(: | as )/, ""); gsub(/,/, ""); print }'
}

_voussoir() {
  local program=${COMP_WORDS[0]%-run} current=${COMP_WORDS[COMP_CWORD]} option="" case="" word quote="" IFS=$'\n'
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    case $word in
      -*) option=$word ;;
      *.prm) case=$word ;;
    esac
  done
  local before=${COMP_WORDS[COMP_CWORD-1]}
  case $current in [\"\']*) quote=${current:0:1} current=${current:1} ;; esac
  COMPREPLY=()
  if [[ -z $quote && $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$("$program" --help | grep -oE '(^ +|,)--?[a-z][a-z-]*' | tr -d ' ,')" -- "$current")
  elif [[ $before == --defaults || $before == --list ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(_voussoir_choices "$program" "$before" | tr ' ' '\n')" -- "$current")
  elif [[ $option == --set && $current != *.prm ]]; then
    # read once for each case
    if [[ ${_voussoir_known-} != "$program $case" ]]; then
      _voussoir_known="$program $case"
      mapfile -t _voussoir_paths < <(_voussoir_entries "$program" "$case")
    fi
    [[ $quote ]] || current=${current//\\/}
    local path rest
    for path in "${_voussoir_paths[@]}"; do
      [[ $path == "$current"* ]] || continue
      if [[ ! $quote ]]; then # up to the next level; readline would close a quotation there
        rest=${path#"$current"}
        [[ $rest == */* ]] && path=$current${rest%%/*}/
        printf -v path '%q' "$path"
      fi
      [[ ${COMPREPLY[*]: -1} == "$path" ]] || COMPREPLY+=("$path")
    done
    compopt -o nospace 2>/dev/null
  else
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -f -X '!*.prm' -- "$current"; compgen -d -- "$current")
  fi
}
complete -F _voussoir voussoir voussoir-run
