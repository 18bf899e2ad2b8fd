// The questions of a setup in German, in the wording of page/src/words.
#include "service/setup/setup_language.hpp"

namespace cell {
namespace {

constexpr QuestionWords kGermanQuestions[] = {
    {"/name", "Name der Zelle", "Er steht auf der Seite, in Berichten und in Meldungen an einen Broker."},
    {"/arm", "Welcher Arm",
     "Der Name eines mitgelieferten Arms (tx90, tx60, three-parallel), der Pfad der Datei eines Arms, „urdf "
     "DATEI BASIS SPITZE“ für einen URDF-Roboter mit den Gliedern, zwischen denen seine sechs Gelenke sind, "
     "oder "
     "„dh DATEI standard“ (oder modified) für eine Tabelle von Denavit-Hartenberg-Parametern."},
    {"/arm/body_radii_mm", "Radien seiner sechs Körper: Schulter, Oberarm, Ellbogen, Unterarm, Hand, Flansch",
     "Alle Wege werden mit ihnen geprüft. Leer nimmt 9 bis 4 % der Länge des Arms an, was zu dick sein kann, "
     "um "
     "sich zu bewegen, oder zu dünn, um sicher zu sein: messen Sie sie."},
    {"/arm_serial", "Seriennummer des Arms",
     "Wie getVersion(\"ArmSN\") der Steuerung sie angibt, sonst wie auf seinem Schild; leer, wenn sie nicht "
     "bekannt ist."},
    {"/controller_serial", "Seriennummer der Steuerung",
     "Wie auf ihrem Schild; leer, wenn sie nicht bekannt ist."},
    {"/base/position_mm", "Wo die Basis des Arms im Rahmen des Blocks ist: x y z",
     "Der Rahmen des Blocks hat seinen Ursprung in der Mitte der Unterseite des Blocks und y nach unten. Die "
     "Basis ist der Punkt der Achse 1 in Höhe der Schulter (wo seine Steuerung ihr Weltsystem hat), bei "
     "einem "
     "Arm aus einem URDF dessen Basisglied, aus einer Tabelle deren erster Rahmen. Mit dem Bandmaß bis auf "
     "die "
     "Abweichung genügt: touchcal locate findet sie. Leer: was die Datei des Arms sagt."},
    {"/base/rotation_deg", "Wie sie dort gedreht ist: Rot(x) Rot(y) Rot(z)",
     "90 0 0 für einen Arm, der auf dem Boden steht und dessen x längs des x des Blocks zeigt; 90 0 w dreht "
     "ihn um w um die Senkrechte; -90 0 0 hängt von der Decke."},
    {"/block/name", "Name des Blocks", "Wie er in Berichten steht."},
    {"/block/serial", "Seriennummer des Blocks", "Wie eingraviert; leer, wenn er keine hat."},
    {"/block/size_mm", "Seine Längen nach dem Zertifikat, bei 20 °C: längs x, seine Höhe, längs z",
     "Der Block ist ein Quader, der auf einer Fläche steht. In der Regel führt x vom Arm weg, z nach links, "
     "von "
     "ihm aus gesehen."},
    {"/block/std_mm", "Standardabweichung jeder davon",
     "Die Hälfte der erweiterten Unsicherheit des Zertifikats (k = 2). Die Ebenheit der Flächen gehört "
     "dazu."},
    {"/block/sides", "Seiten, die angetastet werden, jede mit dem Namen, den ihr die Bediener geben",
     "-x, +x, -z, +z und -y (die Oberseite) nach der Richtung, in die die Seite zeigt. Mindestens drei "
     "Richtungen; mit der Grundplatte vier Flächen."},
    {"/block/ground_plate", "Steht er auf einer zertifizierten Grundplatte, die auch angetastet wird",
     "Ihre Oberseite liegt in der Ebene der Unterseite des Blocks. Dann zählt die Höhe als Länge, und der "
     "Arm "
     "wird tiefer gesehen."},
    {"/block/plate_mm", "Größe der Platte: längs x, ihre Dicke, längs z",
     "Der Block steht in ihrer Mitte. Sie ist längs x und z mindestens 110 mm größer als der Block."},
    {"/block/temperature_c", "Temperatur des Blocks",
     "Auf der der Raum gehalten wird; leer, wenn sie mit jedem Lauf kommt (touchcal run "
     "--block-temperature)."},
    {"/block/std_temperature_k", "Standardabweichung der Temperatur",
     "Dessen, was der Block hat, nicht des Thermometers."},
    {"/block/thermal_expansion_per_k", "Wärmeausdehnung seines Werkstoffs",
     "2.36e-5 für Aluminium, 1.15e-5 für Stahl, 0.1e-5 für Invar."},
    {"/block/certificate/number", "Nummer des Zertifikats", "Leer, wenn es keines gibt."},
    {"/block/certificate/laboratory", "Labor, das es ausgestellt hat", "Leer, wenn es keines gibt."},
    {"/block/certificate/issued", "Tag der Ausstellung", "Leer, wenn er nicht bekannt ist."},
    {"/block/certificate/valid_until", "Tag, bis zu dem es gilt",
     "Der Dienst sagt es 30 Tage vorher; leer, wenn es kein Ende hat."},
    {"/block/places", "An wie vielen weiteren Plätzen wird der Block auch angetastet",
     "0 in der Regel. Auf einem Ständer anderswo zeigt er mehr vom Arm: die Zelle hat dann auch ein Rezept "
     "`places`, in dem eine Person den Block versetzt, wenn der Lauf es verlangt."},
    {"/block/places/#/name", "Platz {}: sein Name", "a bis z, 0 bis 9 und _; nicht first."},
    {"/block/places/#/position_mm", "Platz {}: wo der Rahmen des Blocks dann ist: x y z",
     "Im Rahmen des Blocks an seinem ersten Platz; y zeigt nach unten, ein Ständer hebt also durch ein "
     "negatives "
     "y."},
    {"/block/places/#/rotation_deg", "Platz {}: Rot(x) Rot(y) Rot(z)", ""},
    {"/block/places/#/within_mm", "Platz {}: wie weit davon eine Person ihn hinstellen darf",
     "Höchstens 50; die Antastungen finden ihn. Ein Ständer mit Passstiften, dessen Platz zertifiziert ist: "
     "ändern Sie block.json."},
    {"/probe/name", "Name des Tasters", "Wie er in Berichten steht."},
    {"/probe/serial", "Seriennummer des Tasters", "Leer, wenn er keine hat."},
    {"/probe/ball_radius_mm", "Radius der Tastkugel", "Nach ihrem Zertifikat; der halbe Durchmesser."},
    {"/probe/std_ball_radius_mm", "Standardabweichung des Radius", ""},
    {"/probe/pretravel_mm", "Vorlauf",
     "Wie weit die Kugel vom Kontakt bis zum Auslösen weitergeht, längs des Taststifts. touchcal qualify "
     "misst "
     "mehr davon."},
    {"/probe/std_pretravel_mm", "Standardabweichung des Vorlaufs", ""},
    {"/probe/overtravel_mm", "Überlauf",
     "Wie weit der Taststift ausgelenkt werden darf, bevor er bricht: die kleinste seiner Richtungen."},
    {"/probe/speed_mm_s", "Geschwindigkeit des Kontakts, der zählt",
     "Bei der der Vorlauf gemessen wurde; höchstens 8. Jede Antastung wird mit dieser Geschwindigkeit "
     "wiederholt."},
    {"/probe/length_mm", "Abstand zur Mitte der Kugel, längs der Achse 6",
     "Vom Handwurzelpunkt, nicht vom Flansch; bei einem Arm aus einem URDF oder einer Tabelle von dessen "
     "Spitze. Leer: was die Datei des Arms hat, oder die Teile unten zusammen."},
    {"/probe/stem_length_mm", "Schaft: von der Mitte der Kugel zum Körper des Tasters", ""},
    {"/probe/stem_radius_mm", "Radius des Schafts", "Dünner als die Kugel."},
    {"/probe/body_length_mm", "Länge des Körpers des Tasters", ""},
    {"/probe/body_radius_mm", "Radius des Körpers des Tasters", ""},
    {"/probe/holder_length_mm", "Länge des Werkzeughalters zwischen Flansch und Taster",
     "0, wenn es keinen gibt."},
    {"/probe/holder_radius_mm", "Radius des Werkzeughalters mit allem, was daran ist", ""},
    {"/workspace_box/name", "Kasten, in dem der Arm stimmen soll: sein Name",
     "Wie er heißt, wenn er im Weg ist."},
    {"/workspace_box/min_mm", "Kasten, in dem der Arm stimmen soll: kleinste x y z",
     "Im Rahmen des Blocks; y zeigt nach unten, das kleinste y ist also das höchste."},
    {"/workspace_box/max_mm", "Kasten, in dem der Arm stimmen soll: größte x y z",
     "Über dem kleinsten, bei jedem der drei."},
    {"/keep_out_boxes", "Wie viele Kästen muss der Arm meiden, außer Block und Platte",
     "Tisch, Zäune, Maschinen: alles, worauf er zwischen seiner Parkstellung und dem Block treffen könnte."},
    {"/keep_out_boxes/#/name", "Zu meidender Kasten {}: sein Name", "Wie er heißt, wenn er im Weg ist."},
    {"/keep_out_boxes/#/min_mm", "Zu meidender Kasten {}: kleinste x y z",
     "Im Rahmen des Blocks; y zeigt nach unten, das kleinste y ist also das höchste."},
    {"/keep_out_boxes/#/max_mm", "Zu meidender Kasten {}: größte x y z",
     "Über dem kleinsten, bei jedem der drei."},
    {"/nominal_miss_mm",
     "Wie weit der nicht kalibrierte Arm danebengehen darf, sein Platz nach Bandmaß eingeschlossen",
     "Alle Wege halten diesen Abstand, und Suchwege beginnen so weit vor einer Fläche; 12 für einen Arm, der "
     "lokalisiert wurde."},
    {"/stylus_tilt_max_deg", "Größter Winkel zwischen Taststift und Flächennormale",
     "Ein größerer zeigt mehr vom Arm; unter 90."},
    {"/touch_noise_mm", "Streuung einer Antastung längs der Normale, eine Standardabweichung",
     "0.02 für einen Messtaster an einem Arm."},
    {"/park_joints_deg", "Parkstellung, sechs Gelenke",
     "Wo ein Lauf beginnt und endet, frei von allem; leer: eine wird gesucht."},
    {"/limits/held_out_mean_max_mm",
     "Grenze: mittlerer Abstand der Antastungen, die nicht angepasst wurden, auf jeder Fläche", ""},
    {"/limits/held_out_rms_max_mm", "Grenze: ihr quadratisches Mittel", ""},
    {"/limits/condition_number_max", "Grenze: Konditionszahl",
     "300 in der Regel; ein gut geplanter Lauf hat 20 bis 60."},
    {"/limits/tip_box_max_mm",
     "Grenze: erweiterte Unsicherheit der Spitze an der schlechtesten Stelle im Kasten",
     "k = 2. Für die Rezepte quick und best wird sie, was ihre Pläne versprechen, und die Hälfte mehr."},
    {"/tools", "Wie viele Werkzeuge hat der Arm",
     "Werkzeugmittelpunkte, deren Genauigkeit vorhergesagt wird und deren Programme korrigiert werden."},
    {"/tools/#/name", "Werkzeug {}: sein Name", "Wie Programme es nennen."},
    {"/tools/#/position_mm", "Werkzeug {}: seine Spitze vom Handwurzelpunkt aus: x y z",
     "In R_6, dessen Ursprung der Handwurzelpunkt ist und nicht der Flansch."},
    {"/tools/#/rotation_deg", "Werkzeug {}: Rot(x) Rot(y) Rot(z)", "Wie in VAL3."},
    {"/tools/#/tip/radius_mm", "Werkzeug {}: Radius der Kugel an seiner Spitze",
     "Eines Werkzeugs, das den Block selbst antasten kann, oder mit einem Einstellstift an seiner Stelle "
     "(touchcal tool NAME); 0 für eine Spitze, leer, wenn es das nicht kann."},
    {"/tools/#/tip/std_radius_mm", "Werkzeug {}: Standardabweichung dieses Radius", ""},
    {"/default_recipe", "Rezept eines Laufs, der keines nennt: quick oder best",
     "quick: 40 Antastungen und 10 zurückgehaltene auf jeder Fläche, best: 100."},
    {"/controller/host", "Rechner der Steuerung", "Wo die VAL3-Anwendung lauscht."},
    {"/controller/port", "Port der Steuerung", "11000 in der Regel."}};

}  // namespace

const std::span<const QuestionWords> kQuestionsDe = kGermanQuestions;

}  // namespace cell
