# Completion of `stillpoint` for bash: the program itself says what can follow.
_stillpoint() {
  local word help current=${COMP_WORDS[COMP_CWORD]} line=${COMP_LINE:0:COMP_POINT}
  local -a words  # COMP_WORDS are cut at '=' and ':'
  read -ra words <<<"$line"
  [[ $line == *[[:space:]] ]] && words+=("")
  COMPREPLY=()
  while IFS=$'\t' read -r word help; do
    case $word in
      "<files>") compopt -o filenames; mapfile -O "${#COMPREPLY[@]}" -t COMPREPLY < <(compgen -f -- "$current") ;;
      "<folders>") compopt -o filenames; mapfile -O "${#COMPREPLY[@]}" -t COMPREPLY < <(compgen -d -- "$current") ;;
      *) COMPREPLY+=("$word") ;;
    esac
  done < <("${COMP_WORDS[0]}" --complete "${words[@]:1}" 2>/dev/null)
}
complete -F _stillpoint stillpoint
