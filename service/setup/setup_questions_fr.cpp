// The questions of a setup in French, in the wording of page/src/words.
#include "service/setup/setup_language.hpp"

namespace cell {
namespace {

constexpr QuestionWords kFrenchQuestions[] = {
    {"/name", "Nom de la cellule",
     "Il figure sur la page, dans les rapports et dans les messages à un courtier."},
    {"/arm", "Bras",
     "Le nom d’un bras livré (tx90, tx60, three-parallel), le chemin du fichier d’un bras, « urdf FICHIER "
     "BASE POINTE » pour un robot URDF avec les corps entre lesquels sont ses six articulations, ou « dh "
     "FICHIER standard » (ou modified) pour une table de paramètres de Denavit-Hartenberg."},
    {"/arm/body_radii_mm", "Rayons de ses six corps : épaule, bras, coude, avant-bras, poignet, bride",
     "Toutes les trajectoires sont vérifiées avec eux. Un champ vide suppose 9 à 4 % de la longueur du bras, "
     "ce "
     "qui peut être trop gros pour bouger ou trop mince pour être sûr : mesurez-les."},
    {"/arm_serial", "Numéro de série du bras",
     "Tel que getVersion(\"ArmSN\") de la baie le donne, sinon tel que sur sa plaque ; vide s’il n’est pas "
     "connu."},
    {"/controller_serial", "Numéro de série de la baie",
     "Tel que sur sa plaque ; vide s’il n’est pas connu."},
    {"/base/position_mm", "Où est la base du bras dans le repère du bloc : x y z",
     "L’origine du repère du bloc est au milieu de sa face inférieure, y vers le bas. La base est le point "
     "de l’axe 1 à la hauteur de l’épaule (où sa baie a son repère monde), pour un bras d’un URDF son corps "
     "de "
     "base, d’une table son premier repère. Au mètre ruban, à l’écart près, cela suffit : touchcal locate la "
     "trouve. Vide : ce que dit le fichier du bras."},
    {"/base/rotation_deg", "Comment elle y est tournée : Rot(x) Rot(y) Rot(z)",
     "90 0 0 pour un bras posé au sol dont x suit le x du bloc ; 90 0 w le tourne de w autour de la "
     "verticale ; -90 0 0 pend au plafond."},
    {"/block/name", "Nom du bloc", "Tel qu’il figure dans les rapports."},
    {"/block/serial", "Numéro de série du bloc", "Tel que gravé ; vide s’il n’en a pas."},
    {"/block/size_mm", "Ses longueurs selon le certificat, à 20 °C : selon x, sa hauteur, selon z",
     "Le bloc est un pavé posé sur une face. En règle générale x s’éloigne du bras, et z va à gauche vu de "
     "lui."},
    {"/block/std_mm", "Écart-type de chacune",
     "La moitié de l’incertitude élargie du certificat (k = 2). La planéité des faces en fait partie."},
    {"/block/sides", "Côtés palpés, chacun avec le nom que lui donnent les opérateurs",
     "-x, +x, -z, +z et -y (le dessus) selon la direction vers laquelle le côté est tourné. Au moins trois "
     "directions ; avec la plaque de base quatre faces."},
    {"/block/ground_plate", "Est-il posé sur une plaque de base certifiée qui est palpée aussi",
     "Son dessus est dans le plan du dessous du bloc. La hauteur compte alors comme une longueur, et le bras "
     "est "
     "vu plus bas."},
    {"/block/plate_mm", "Dimensions de la plaque : selon x, son épaisseur, selon z",
     "Le bloc est en son milieu. Elle a au moins 110 mm de plus que le bloc selon x et z."},
    {"/block/temperature_c", "Température du bloc",
     "Celle à laquelle le local est tenu ; vide si elle vient avec chaque cycle (touchcal run "
     "--block-temperature)."},
    {"/block/std_temperature_k", "Écart-type de la température", "De celle du bloc, non du thermomètre."},
    {"/block/thermal_expansion_per_k", "Dilatation thermique de sa matière",
     "2.36e-5 pour l’aluminium, 1.15e-5 pour l’acier, 0.1e-5 pour l’Invar."},
    {"/block/certificate/number", "Numéro du certificat", "Vide s’il n’y en a pas."},
    {"/block/certificate/laboratory", "Laboratoire qui l’a établi", "Vide s’il n’y en a pas."},
    {"/block/certificate/issued", "Jour de l’établissement", "Vide s’il n’est pas connu."},
    {"/block/certificate/valid_until", "Jour jusqu’auquel il est valable",
     "Le démon le dit 30 jours avant ; vide s’il n’a pas de fin."},
    {"/block/places", "À combien d’autres endroits le bloc est-il palpé aussi",
     "0 en règle générale. Sur un support ailleurs il montre davantage du bras : la cellule a alors aussi "
     "une "
     "recette `places`, dans laquelle une personne déplace le bloc quand le cycle le demande."},
    {"/block/places/#/name", "Place {} : son nom", "a à z, 0 à 9 et _ ; pas first."},
    {"/block/places/#/position_mm", "Place {} : où est alors le repère du bloc : x y z",
     "Dans le repère du bloc à son premier endroit ; y va vers le bas, un support lève donc par un y "
     "négatif."},
    {"/block/places/#/rotation_deg", "Place {} : Rot(x) Rot(y) Rot(z)", ""},
    {"/block/places/#/within_mm", "Place {} : à quelle distance de là une personne peut le poser",
     "Au plus 50 ; les palpages le trouvent. Un support à pions dont l’endroit est certifié : modifiez "
     "block.json."},
    {"/probe/name", "Nom du palpeur", "Tel qu’il figure dans les rapports."},
    {"/probe/serial", "Numéro de série du palpeur", "Vide s’il n’en a pas."},
    {"/probe/ball_radius_mm", "Rayon de la bille du stylet", "Selon son certificat ; la moitié du diamètre."},
    {"/probe/std_ball_radius_mm", "Écart-type du rayon", ""},
    {"/probe/pretravel_mm", "Précourse",
     "Ce que la bille parcourt du contact au déclenchement, le long du stylet. touchcal qualify en mesure "
     "davantage."},
    {"/probe/std_pretravel_mm", "Écart-type de la précourse", ""},
    {"/probe/overtravel_mm", "Surcourse",
     "De combien le stylet peut plier avant de casser : la plus petite de ses directions."},
    {"/probe/speed_mm_s", "Vitesse du contact qui compte",
     "Celle à laquelle la précourse a été mesurée ; au plus 8. Chaque palpage est refait à cette vitesse."},
    {"/probe/length_mm", "Distance jusqu’au centre de la bille, le long de l’axe 6",
     "À partir du centre du poignet, non de la bride ; pour un bras d’un URDF ou d’une table à partir de sa "
     "pointe. Vide : ce qu’a le fichier du bras, ou la somme des parties ci-dessous."},
    {"/probe/stem_length_mm", "Tige : du centre de la bille au corps du palpeur", ""},
    {"/probe/stem_radius_mm", "Rayon de la tige", "Plus mince que la bille."},
    {"/probe/body_length_mm", "Longueur du corps du palpeur", ""},
    {"/probe/body_radius_mm", "Rayon du corps du palpeur", ""},
    {"/probe/holder_length_mm", "Longueur du porte-outil entre la bride et le palpeur",
     "0 s’il n’y en a pas."},
    {"/probe/holder_radius_mm", "Rayon du porte-outil, avec tout ce qui est dessus", ""},
    {"/workspace_box/name", "Volume où le bras doit être juste : son nom", "Son nom quand il gêne."},
    {"/workspace_box/min_mm", "Volume où le bras doit être juste : plus petits x y z",
     "Dans le repère du bloc ; y va vers le bas, le plus petit y est donc le plus haut."},
    {"/workspace_box/max_mm", "Volume où le bras doit être juste : plus grands x y z",
     "Au-dessus du plus petit pour chacun des trois."},
    {"/keep_out_boxes", "Combien de volumes le bras doit-il éviter, outre le bloc et la plaque",
     "Table, clôtures, machines : tout ce qu’il pourrait rencontrer entre sa position de repos et le bloc."},
    {"/keep_out_boxes/#/name", "Volume {} à éviter : son nom", "Son nom quand il gêne."},
    {"/keep_out_boxes/#/min_mm", "Volume {} à éviter : plus petits x y z",
     "Dans le repère du bloc ; y va vers le bas, le plus petit y est donc le plus haut."},
    {"/keep_out_boxes/#/max_mm", "Volume {} à éviter : plus grands x y z",
     "Au-dessus du plus petit pour chacun des trois."},
    {"/nominal_miss_mm",
     "De combien le bras non étalonné peut se tromper, son endroit au mètre ruban compris",
     "Toutes les trajectoires gardent cette distance et les recherches commencent aussi loin d’une face ; 12 "
     "pour un bras qui a été localisé."},
    {"/stylus_tilt_max_deg", "Plus grand angle entre le stylet et la normale à la face",
     "Plus grand, il montre davantage du bras ; moins de 90."},
    {"/touch_noise_mm", "Dispersion d’un palpage le long de la normale, un écart-type",
     "0.02 pour un palpeur à contact sur un bras."},
    {"/park_joints_deg", "Posture de repos, six articulations",
     "Où un cycle commence et finit, loin de tout ; vide : elle est cherchée."},
    {"/limits/held_out_mean_max_mm",
     "Limite : distance moyenne des palpages qui ne sont pas ajustés, sur chaque plan", ""},
    {"/limits/held_out_rms_max_mm", "Limite : leur moyenne quadratique", ""},
    {"/limits/condition_number_max", "Limite : conditionnement",
     "300 en règle générale ; un cycle bien planifié a 20 à 60."},
    {"/limits/tip_box_max_mm", "Limite : incertitude élargie de la pointe au pire endroit du volume",
     "k = 2. Pour les recettes quick et best elle devient ce que promettent leurs plans et la moitié en "
     "plus."},
    {"/tools", "Combien d’outils a le bras",
     "Centres d’outils dont l’exactitude est prédite et dont les programmes sont corrigés."},
    {"/tools/#/name", "Outil {} : son nom", "Tel que les programmes l’appellent."},
    {"/tools/#/position_mm", "Outil {} : sa pointe à partir du centre du poignet : x y z",
     "Dans R_6, dont l’origine est le centre du poignet et non la bride."},
    {"/tools/#/rotation_deg", "Outil {} : Rot(x) Rot(y) Rot(z)", "Comme en VAL3."},
    {"/tools/#/tip/radius_mm", "Outil {} : rayon de la bille à sa pointe",
     "D’un outil qui peut palper le bloc lui-même, ou avec une pige de réglage à sa place (touchcal tool "
     "NOM) ; "
     "0 pour une pointe, vide s’il ne le peut pas."},
    {"/tools/#/tip/std_radius_mm", "Outil {} : écart-type de ce rayon", ""},
    {"/default_recipe", "Recette d’un cycle qui n’en nomme pas : quick ou best",
     "quick : 40 palpages et 10 mis à part sur chaque face, best : 100."},
    {"/controller/host", "Machine de la baie", "Où l’application VAL3 écoute."},
    {"/controller/port", "Port de la baie", "11000 en règle générale."}};

}  // namespace

const std::span<const QuestionWords> kQuestionsFr = kFrenchQuestions;

}  // namespace cell
