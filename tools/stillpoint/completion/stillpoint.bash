# Completion of `stillpoint` for bash: the program itself says what can follow.
_stillpoint() {
  local word help joins=false current=${COMP_WORDS[COMP_CWORD]}
  local -a words=("")
  for word in "${COMP_WORDS[@]:1:COMP_CWORD}"; do  # cut at '=' and ':'
    if [[ $word == [=:]* ]]; then
      words[-1]+=$word joins=true
    elif $joins; then
      words[-1]+=$word joins=false
    else
      words+=("$word")
    fi
  done
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
