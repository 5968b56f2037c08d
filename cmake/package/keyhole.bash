# Completion of keyhole's command line for bash. Commands, options, methods and settings are what --help lists.
_keyhole() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} program=${COMP_WORDS[0]} command='' i
    for ((i = 1; i < COMP_CWORD; ++i)); do
        [[ ${COMP_WORDS[i]} == -* ]] || { command=${COMP_WORDS[i]}; break; }
    done
    COMPREPLY=()
    local help words=''
    help=$("$program" ${command:+"$command"} --help 2>/dev/null) || return 0
    if [[ -z $command ]]; then
        words="--help --version $(sed -n '/^Subcommands:/,$s/^  \([a-z]\+\) .*/\1/p' <<<"$help")"
    elif [[ $before == --method ]]; then
        words=$(sed -n '/^Methods:/,/^$/s/^  \([a-z]\+\) .*/\1/p' <<<"$help")
    elif [[ $before == --quality ]]; then
        words='draft good final'
    elif [[ $before == --denoise ]]; then
        words='png exr off'
    elif [[ $before == -D ]]; then
        words=$(sed -n '/^Settings /,$s/^  \([a-z_.]\+=\).*/\1/p' <<<"$help")
        compopt -o nospace 2>/dev/null
    elif [[ $word == -* ]]; then
        words=$(grep -oE -- '--[a-z][a-z-]*' <<<"$help" | sort -u)
    fi
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
}
complete -o default -F _keyhole keyhole
