#!/bin/sh
# Writes the configuration of the service. Usage: environment.sh PROGRAM FILE
set -eu
{
  cat <<'END'
# Settings of the vat service. Remove the # before a setting to change it, then type:
#
#     systemctl restart vat
#
# The service stores its sessions in /var/lib/vat. Clients of other machines need VAT_HOST=0.0.0.0,
# and then a token: `journalctl --unit vat` shows a link with the token of the administrator.

END
  # The service sets the folder of the data. The scenes and the viewer belong to the program.
  env -i "$1" serve --print-variables |
    awk -v RS= -v ORS='\n\n' '!/#VAT_(DATA|SCENES|WEB)=/'
} >"$2"
